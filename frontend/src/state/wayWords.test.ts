import { expect, it } from "vitest";
import { someLeg } from "../wire/examples";
import { noseWords, wayWords, whyLeftOut } from "./wayWords";

it("says of a leg how much of it counts and how far the antenna turned", () => {
  expect(wayWords(someLeg())).toBe("On the way to place 2: 2 × 20 m used, turned 120°");
});

it("says honestly that a leg told nothing, and why", () => {
  const told = someLeg({ stretches: [], readings: null, left_out: [{ code: "readings_left_out", why: "pointed_one_way", readings: 90 }] });
  expect(wayWords(told)).toBe("On the way to place 2: nothing that tells a direction");
  expect(whyLeftOut(told)).toEqual(["90 readings left out: the antenna pointed one way, so their power shows no direction."]);
});

it("says what the nose did", () => {
  const swung = { code: "nose_swung", swung: 4, amplitude_deg: 75, rate_deg_s: 24, lag_deg: 12, end: "near_place" } as const;
  expect(noseWords(someLeg())).toEqual([]);
  expect(noseWords(someLeg({ nose: [swung] }))).toEqual([
    "The nose swung by 75 degrees to either side, 4 times to the end, at 24 degrees/s and at most 12 degrees behind, until the place was near.",
  ]);
});
