import { expect, it } from "vitest";
import { NotAPlan, readPlan } from "./qgcPlan";

const plan = (geoFence: unknown) => JSON.stringify({ fileType: "Plan", geoFence });

it("turns latitude-first corners into closed GeoJSON rings", () => {
  const found = readPlan(
    plan({
      polygons: [
        {
          inclusion: true,
          polygon: [
            [50, 7],
            [50, 8],
            [51, 8],
          ],
        },
      ],
    }),
  );
  expect(found.inclusions).toEqual([
    [
      [
        [7, 50],
        [8, 50],
        [8, 51],
        [7, 50],
      ],
    ],
  ]);
});

it("keeps what must not be entered apart", () => {
  const found = readPlan(
    plan({
      polygons: [
        {
          inclusion: false,
          polygon: [
            [50, 7],
            [50, 8],
            [51, 8],
          ],
        },
      ],
      circles: [{ inclusion: false, circle: { center: [50, 7], radius: 20 } }],
    }),
  );
  expect(found.exclusions).toHaveLength(2);
  expect(found.inclusions).toHaveLength(0);
});

it.each([
  ["not JSON", "{"],
  ["nothing", "null"],
  ["another file", JSON.stringify({ fileType: "Mission" })],
  ["no fence", plan({ polygons: [] })],
  [
    "two corners",
    plan({
      polygons: [
        {
          polygon: [
            [1, 2],
            [3, 4],
          ],
        },
      ],
    }),
  ],
  ["no radius", plan({ circles: [{ circle: { center: [1, 2] } }] })],
  ["an endless radius", plan({ circles: [{ circle: { center: [1, 2], radius: 1e300 } }] })],
  ["a circle that is none", plan({ circles: [null] })],
  ["a centre that is no place", plan({ circles: [{ circle: { center: "here", radius: 5 } }] })],
  ["a polygon that is none", plan({ polygons: [null] })],
  ["corners that are a word", plan({ polygons: [{ polygon: "corners" }] })],
  ["a corner that is none", plan({ polygons: [{ polygon: [[50, 7], null, [51, 8]] }] })],
  [
    "a corner beyond the pole",
    plan({
      polygons: [
        {
          polygon: [
            [50, 7],
            [500, 8],
            [51, 8],
          ],
        },
      ],
    }),
  ],
  ["a fence that is none", plan(7)],
])("says why it cannot read a plan: %s", (_name, text) => {
  expect(() => readPlan(text)).toThrow(NotAPlan);
  expect(() => readPlan(text)).toThrow(/^edit\.plan\./);
});
