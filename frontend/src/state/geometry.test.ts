import { describe, expect, it } from "vitest";
import type { LonLat } from "../wire/beliefFrame";
import { bearingDeg, boundsOf, circle, destination, distanceM, extent, metresPerDegree, ringAreaM2, wedge } from "./geometry";

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
    const [outline, half] = [circle(from, 1000, 36).slice(1), 18];
    expect(ringAreaM2([...outline.slice(half), ...outline.slice(0, half)])).toBeCloseTo(ringAreaM2(outline), 3);
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

it("measures how far a region reaches, and which way", () => {
  const middle: LonLat = [7.2, 50.62];
  const ends = [destination(middle, 129, 20), destination(middle, 309, 20)];
  const { metres, bearing } = extent([destination(middle, 39, 5), ...ends, destination(middle, 219, 5)]);
  expect(metres).toBeCloseTo(40, 2);
  expect(bearing).toBeCloseTo(129, 1);
  expect(extent([middle])).toEqual({ metres: 0, bearing: 0 });
  expect(extent([])).toEqual({ metres: 0, bearing: 0 });
});

it("measures across the antimeridian as anywhere else", () => {
  const wrapped = (points: LonLat[]) => points.map(([lon, lat]): LonLat => [((lon + 540) % 360) - 180, lat]);
  const ring = circle([179.999, -17], 300);
  const over = wrapped(ring);
  expect(over.some(([lon]) => lon < 0)).toBe(true);
  expect(distanceM(over[0]!, over[36]!)).toBeCloseTo(600, 1);
  expect(bearingDeg([179.999, -17], [-179.999, -17])).toBeCloseTo(90, 2);
  expect(extent(over).metres).toBeCloseTo(extent(ring).metres, 6);
  expect(ringAreaM2(over)).toBeCloseTo(ringAreaM2(ring), 3);
  const [west, , east] = boundsOf(over)!;
  expect(east - west).toBeCloseTo(boundsOf(ring)![2] - boundsOf(ring)![0], 9);
  expect(
    boundsOf([
      [-170, 0],
      [20, 0],
      [10, 1],
    ]),
  ).toEqual([-170, 0, 20, 1]);
});

it("finds the same reach as asking every pair of corners, of any shape", () => {
  let state = 7;
  const random = () => {
    state = (state * 16807) % 2147483647;
    return state / 2147483647 - 0.5;
  };
  const shapes: [number, number][] = [
    [1, 1],
    [1, 0.01],
    [1, 0],
    [0, 1],
    [0, 0],
  ];
  for (const [wide, high] of shapes) {
    for (const count of [1, 2, 3, 4, 7, 20]) {
      for (let again = 0; again < 5; again++) {
        const points = Array.from({ length: count }, (): LonLat => [7.2 + 0.01 * wide * random(), 50.6 + 0.01 * high * random()]);
        const closed = [...points, points[0]!, points.at(-1)!];
        const farthest = Math.max(...closed.flatMap((a) => closed.map((b) => distanceM(a, b))));
        expect(extent(closed).metres).toBeCloseTo(farthest, 6);
      }
    }
  }
});

it("measures a region of twenty thousand corners", () => {
  const around = circle([7.2, 50.62], 400, 20_000);
  expect(extent(around).metres).toBeCloseTo(800, 1);
});

it("bounds more points than a call takes arguments", () => {
  const points = Array.from({ length: 500_000 }, (_, i): LonLat => [i / 1e4, -i / 1e5]);
  expect(boundsOf(points)).toEqual([0, -4.99999, 49.9999, -0]);
});
