import { expect, it } from "vitest";
import { record, somePlan } from "./examples";
import { remainingTime } from "./timeLeft";

const recorded = record(somePlan())[0]!;
const plan = { fact: somePlan(), seq: 1, at: recorded.at_utc };
const begun = Date.parse(recorded.at_utc);

it("counts down from the plan and stops at nothing", () => {
  expect(remainingTime(plan, begun)).toEqual({ meanS: 120, worstS: 200 });
  expect(remainingTime(plan, begun + 50_000)).toEqual({ meanS: 70, worstS: 150 });
  expect(remainingTime(plan, begun + 150_000)).toEqual({ meanS: 0, worstS: 50 });
});

it("is unknown when the planner gave no time", () => {
  expect(remainingTime({ ...plan, fact: somePlan({ expected_time_s: null }) }, begun)).toBeNull();
});
