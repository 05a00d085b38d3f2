// What of the vehicle's movement is worth drawing: each change on the page draws a whole frame, and a hovering vehicle always trembles.
import type { LonLat } from "../wire/beliefFrame";
import { distanceM } from "./geometry";

/** Where the vehicle is drawn; degrees clockwise from north. */
export interface VehicleView {
  at: LonLat | null;
  headingDeg: number | null;
  speedMs: number | null;
}

export const unseen: VehicleView = { at: null, headingDeg: null, speedMs: null };

/** A pixel or two of the map; what an arrow of 36 pixels shows; what an arrival time in seconds shows. */
const STEP_M = 0.3;
const STEP_DEG = 4;
const STEP_M_S = 0.3;

const near = (before: number | null, now: number | null, step: number) =>
  before === null || now === null ? before === now : Math.abs(now - before) < step;

const turned = (before: number | null, now: number | null) =>
  before === null || now === null ? now : before + ((((now - before + 180) % 360) + 360) % 360) - 180;

/** The same object while nothing has moved by a step since it was drawn. */
export function withoutTremble(before: VehicleView, now: VehicleView): VehicleView {
  const stood = before.at === null || now.at === null ? before.at === now.at : distanceM(before.at, now.at) < STEP_M;
  const same =
    stood && near(before.headingDeg, turned(before.headingDeg, now.headingDeg), STEP_DEG) && near(before.speedMs, now.speedMs, STEP_M_S);
  return same ? before : now;
}
