// How likely the emitter is near a place: the belief's mass in a circle.
import type { BeliefFrame, LonLat } from "../wire/beliefFrame";
import { distanceM, together } from "./geometry";

/** Share of the belief, 0..1, not farther than `radiusM` from `place`; a cell on the circle counts in part. */
export function shareWithin(frame: Pick<BeliefFrame, "nx" | "ny" | "bounds" | "cells">, place: LonLat, radiusM: number): number {
  const { nx, ny, cells } = frame;
  const [sw, se, ne, nw] = together(frame.bounds) as BeliefFrame["bounds"];
  const cellM = distanceM(sw, se) / nx;
  let all = 0;
  let near = 0;
  cells.forEach((mass, k) => {
    if (mass === 0) return;
    const [u, v] = [((k % nx) + 0.5) / nx, (Math.floor(k / nx) + 0.5) / ny];
    const along = (axis: 0 | 1) => (1 - v) * ((1 - u) * sw[axis] + u * se[axis]) + v * ((1 - u) * nw[axis] + u * ne[axis]);
    const inside = (radiusM - distanceM([along(0), along(1)], place)) / cellM + 0.5;
    all += mass;
    near += mass * Math.min(1, Math.max(0, inside));
  });
  return all === 0 ? 0 : near / all;
}
