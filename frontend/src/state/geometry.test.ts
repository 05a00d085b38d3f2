import { describe, expect, it } from "vitest";
import type { LonLat } from "../wire/beliefFrame";
import { bearingDeg, circle, destination, distanceM, metresPerDegree, ringAreaM2, wedge } from "./geometry";

const places: LonLat[] = [
  [7.2, 50.62],
  [-70.3, -33.4],
  [0, 0],
  [25.7, 66.5],
];

describe.each(places)("around %f, %f", (lon, lat) => {
  const from: LonLat = [lon, lat];

  it("destination, distance and bearing agree", () => {
    for (const bearing of [0, 17, 90, 181, 333]) {
      for (const metres of [1, 50, 800]) {
        const to = destination(from, bearing, metres);
        expect(distanceM(from, to)).toBeCloseTo(metres, metres > 100 ? 0 : 2);
        expect(Math.abs(((bearingDeg(from, to) - bearing + 540) % 360) - 180)).toBeLessThan(0.1);
      }
    }
  });

  it("a circle has the area of a circle", () => {
    expect(ringAreaM2(circle(from, 100, 360)) / (Math.PI * 1e4)).toBeCloseTo(1, 3);
  });
});

it("a degree of latitude is the ellipsoid's meridian arc", () => {
  expect(metresPerDegree(0)[1]).toBeCloseTo(110_574, -1);
  expect(metresPerDegree(90)[1]).toBeCloseTo(111_694, -1);
  expect(metresPerDegree(0)[0]).toBeCloseTo(111_320, -1);
});

it("a wedge begins and ends at its apex and spans twice its half width", () => {
  const apex: LonLat = [7, 50];
  const ring = wedge(apex, 350, 15, 200);
  expect(ring[0]).toEqual(apex);
  expect(ring.at(-1)).toEqual(apex);
  expect(bearingDeg(apex, ring[1]!)).toBeCloseTo(335, 1);
  expect(bearingDeg(apex, ring.at(-2)!)).toBeCloseTo(5, 1);
});
