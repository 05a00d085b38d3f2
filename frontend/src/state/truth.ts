// How far the estimate was from where the emitter was found. Pure.
import type { Area, EstimateFact, Place } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { polygonsOf } from "./areas";
import { beside, distanceM, lonLat } from "./geometry";

export interface Judged {
  errorM: number;
  /** Within the 95 % region. */
  inside: boolean;
}

export const judge = (estimate: EstimateFact, truth: Place): Judged => ({
  errorM: distanceM(lonLat(estimate), lonLat(truth)),
  inside: covers(estimate.c95 as Area, lonLat(truth)),
});

/** Even-odd over all rings: a hole takes its ground out again. All beside its first corner, across the antimeridian too. */
export function covers(area: Area, [lon, y]: LonLat): boolean {
  const rings = polygonsOf(area).flat();
  const first = rings[0]?.[0]?.[0] ?? 0;
  const x = beside(lon, first);
  const crossed = rings
    .map((ring) => ring.map(([at, lat]): LonLat => [beside(at, first), lat]))
    .flatMap((ring) => ring.slice(1).map((b, i) => [ring[i]!, b] as const))
    .filter(([a, b]) => a[1] > y !== b[1] > y && x < a[0] + ((y - a[1]) / (b[1] - a[1])) * (b[0] - a[0]));
  return crossed.length % 2 === 1;
}
