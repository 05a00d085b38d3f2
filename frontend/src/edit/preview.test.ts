import { expect, it } from "vitest";
import { histogram } from "./preview";

it("counts every time once", () => {
  const times = [60, 61, 75, 90, 90, 120];
  const { counts, fromS, toS } = histogram(times, 6);
  expect(counts.reduce((a, b) => a + b, 0)).toBe(times.length);
  expect([fromS, toS]).toEqual([60, 120]);
  expect(counts.at(-1)).toBe(1);
});

it("bears times that are all the same", () => {
  expect(histogram([5, 5, 5], 4).counts.reduce((a, b) => a + b, 0)).toBe(3);
});
