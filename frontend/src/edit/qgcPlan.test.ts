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
])("says why it cannot read a plan: %s", (_name, text) => {
  expect(() => readPlan(text)).toThrow(NotAPlan);
  expect(() => readPlan(text)).toThrow(/^edit\.plan\./);
});
