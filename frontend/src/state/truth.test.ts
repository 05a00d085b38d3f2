import { expect, it } from "vitest";
import type { EstimateFact } from "../wire";
import { covers, judge } from "./truth";

const ring = (a: number, b: number): [number, number][] => [
  [a, a],
  [b, a],
  [b, b],
  [a, b],
  [a, a],
];

it("knows what a region covers, holes and several parts too", () => {
  const area = { type: "MultiPolygon" as const, coordinates: [[ring(0, 10), ring(4, 6)], [ring(20, 21)]] };
  expect([1, 5, 20.5, 15].map((at) => covers(area, [at, at]))).toEqual([true, false, true, false]);
});

it("knows it of a region across the antimeridian", () => {
  const corners: [number, number][] = [
    [179.995, 50],
    [-179.995, 50],
    [-179.995, 50.01],
    [179.995, 50.01],
    [179.995, 50],
  ];
  const area = { type: "Polygon" as const, coordinates: [corners] };
  expect([179.996, 180, -180, -179.996, 179.99, -179.99, 0].map((lon) => covers(area, [lon, 50.005]))).toEqual([
    true,
    true,
    true,
    true,
    false,
    false,
    false,
  ]);
});

it("says how far off the estimate was", () => {
  const estimate = {
    lat: 50,
    lon: 7,
    c95: {
      type: "Polygon",
      coordinates: [
        [
          [6, 49],
          [8, 49],
          [8, 51],
          [6, 51],
          [6, 49],
        ],
      ],
    },
  } as unknown as EstimateFact;
  const far = judge(estimate, { lat: 50.001, lon: 7 });
  expect(far.errorM).toBeCloseTo(111.2, 0);
  expect(far.inside).toBe(true);
  expect(judge(estimate, { lat: 50, lon: 9 }).inside).toBe(false);
});
