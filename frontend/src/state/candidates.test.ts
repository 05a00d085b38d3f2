import { expect, it } from "vitest";
import { someBearing, somePlan } from "../wire/examples";
import { isChoosing, rankCandidates, roundShade, SHADES } from "./candidates";

it("the chosen one comes first, then who stayed longest, then the quickest", () => {
  expect(rankCandidates(somePlan()).map((r) => r.index)).toEqual([1, 2, 0]);
  expect(rankCandidates(somePlan())[0]!.chosen).toBe(true);
});

it("later rounds are stronger, survivors stronger still, the chosen one strongest", () => {
  const plan = somePlan();
  const [survivor, second, first] = [plan.candidates[1]!, plan.candidates[2]!, plan.candidates[0]!];
  const shades = [first, second, survivor].map((c) => roundShade(c, plan, false));
  expect(shades.toSorted((a, b) => a - b)).toEqual(shades);
  expect(new Set(shades).size).toBe(3);
  expect(roundShade(survivor, plan, true)).toBe(SHADES + 1);
});

it("nothing is chosen among while a bearing is taken, nor after it; a bearing that somebody reports ends no choice", () => {
  const plan = { fact: somePlan(), seq: 5, at: "" };
  const heard = (seq: number, fact = someBearing()) => ({ fact, seq, at: "", leftOut: false, excluded: false });
  const view = { phase: "flying", plan, bearings: [heard(3)], rejected: [] } as const;
  expect(isChoosing(view)).toBe(true);
  expect(isChoosing({ ...view, phase: "measuring" })).toBe(false);
  expect(isChoosing({ ...view, bearings: [heard(3), heard(7)] })).toBe(false);
  expect(isChoosing({ ...view, bearings: [heard(7, someBearing({ source: { kind: "person", name: "Ada" } }))] })).toBe(true);
});
