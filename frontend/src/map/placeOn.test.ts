import { expect, it } from "vitest";
import { placeOn } from "./placeOn";

it.each([
  [7.2, 7.2],
  [180, 180],
  [-179.998, -179.998],
  [180.002, -179.998],
  [-180.002, 179.998],
  [539.998, 179.998],
])("a place at %d degrees of a map is at %d degrees on earth", (lng, lon) => {
  expect(placeOn({ lng, lat: 50 }).lon).toBeCloseTo(lon, 9);
});
