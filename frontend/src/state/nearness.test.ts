import { expect, it } from "vitest";
import type { LonLat } from "../wire/beliefFrame";
import { beside, destination } from "./geometry";
import { shareWithin } from "./nearness";

const sw: LonLat = [7.1, 50.7];
const [se, nw] = [destination(sw, 90, 100), destination(sw, 0, 100)];
const square = (fill: (i: number) => number) => ({
  nx: 50,
  ny: 50,
  bounds: [sw, se, [se[0], nw[1]], nw] as [LonLat, LonLat, LonLat, LonLat],
  cells: Float32Array.from({ length: 2500 }, (_, i) => fill(i)),
});
const centre: LonLat = [(se[0] + sw[0]) / 2, (nw[1] + sw[1]) / 2];

it("is the circle's share of the area when nothing is known", () => {
  for (const radius of [5, 20, 45]) {
    expect(
      shareWithin(
        square(() => 1),
        centre,
        radius,
      ),
    ).toBeCloseTo((Math.PI * radius ** 2) / 100 ** 2, 2);
  }
  expect(
    shareWithin(
      square(() => 1),
      centre,
      75,
    ),
  ).toBe(1);
});

it("is all of what stands in one cell, or nothing of it", () => {
  const corner = square((i) => (i === 0 ? 1 : 0));
  expect(shareWithin(corner, destination(sw, 45, 1.4), 5)).toBe(1);
  expect(shareWithin(corner, centre, 5)).toBe(0);
});

it("is nothing of no belief", () => {
  expect(
    shareWithin(
      square(() => 0),
      centre,
      50,
    ),
  ).toBe(0);
});

it("counts a belief across the antimeridian as any other", () => {
  const across = (lon: number) => beside(lon - sw[0] + 179.9995, 0);
  const whole = square(() => 1);
  const there = { ...whole, bounds: whole.bounds.map(([lon, lat]): LonLat => [across(lon), lat]) as typeof whole.bounds };
  expect(there.bounds[0][0]).toBeGreaterThan(there.bounds[1][0]);
  expect(shareWithin(there, [across(centre[0]), centre[1]], 20)).toBeCloseTo(shareWithin(whole, centre, 20), 6);
});
