import { expect, it } from "vitest";
import { ageS, freshness } from "./age";

it("a value ages from when it was measured, not from when it arrived", () => {
  expect(ageS(0.5, 1000, 3000)).toBeCloseTo(2.5);
  expect(ageS(null, 1000, 3000)).toBeNull();
  expect(ageS(0.5, null, 3000)).toBeNull();
});

it("fresh, then old, then gone; never heard is gone", () => {
  expect([0, 2.9, 3.1, 29, 31, null].map(freshness)).toEqual(["fresh", "fresh", "old", "old", "gone", "gone"]);
});
