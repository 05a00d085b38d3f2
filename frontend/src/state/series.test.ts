import { expect, it } from "vitest";
import { emptySeries, extend, type Series } from "./series";

const at = (t: number) => ({ t, powerDb: -70, altitudeM: null, batteryPercent: 50 });
const run = (...times: number[]): Series => times.reduce((s, t) => extend(s, at(t)), emptySeries);

it("keeps one value a second, in order", () => {
  expect(run(0, 0.1, 0.9, 1.0, 0.5, 2.2).t).toEqual([0, 1, 2.2]);
});

it("keeps the last five minutes and no more", () => {
  const long = run(...Array.from({ length: 400 }, (_, i) => i));
  expect(long.t).toHaveLength(300);
  expect(long.t.at(-1)).toBe(399);
  expect(long.powerDb).toHaveLength(300);
});
