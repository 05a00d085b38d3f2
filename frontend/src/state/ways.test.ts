import { expect, it } from "vitest";
import type { MissionWays } from "../sources/waysApi";
import { drawnOf } from "./ways";

const known = {
  features: [
    { geometry: { type: "MultiLineString", coordinates: [[[7, 50]], [[8, 50]]] }, properties: { kind: "road" } },
    {
      geometry: {
        type: "MultiPolygon",
        coordinates: [[[[7, 50]], [[7.1, 50]]], [[[9, 50]]]],
      },
      properties: { kind: "barrier" },
    },
  ],
} as unknown as MissionWays;

it("is drawn as lines and as rings of areas, holes among them", () => {
  const [road, water] = drawnOf(known);
  expect(road).toEqual({ kind: "road", area: false, lines: [[[7, 50]], [[8, 50]]] });
  expect(water).toEqual({ kind: "barrier", area: true, lines: [[[7, 50]], [[7.1, 50]], [[9, 50]]] });
  expect(drawnOf(null)).toEqual([]);
});
