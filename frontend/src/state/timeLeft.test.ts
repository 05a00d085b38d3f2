import { expect, it } from "vitest";
import { phase, record, somePlan } from "./examples";
import { missionAt } from "./mission";
import { remainingTime } from "./timeLeft";

/** Seconds after the plan, which is the first event. */
const after = (seconds: number) => Date.UTC(2026, 0, 1, 12, 0, 0) + 1000 * seconds;
const planned = missionAt(record(somePlan()), Infinity);

it("counts down from the plan and stops at nothing", () => {
  expect(remainingTime(planned, after(0))).toEqual({ meanS: 120, worstS: 200 });
  expect(remainingTime(planned, after(50))).toEqual({ meanS: 70, worstS: 150 });
  expect(remainingTime(planned, after(150))).toEqual({ meanS: 0, worstS: 50 });
});

it("stands still in hold, under the pilot and while it waits for the operator", () => {
  for (const still of ["hold", "manual", "waiting"] as const) {
    const held = missionAt(record(somePlan(), phase("flying"), phase(still)), Infinity);
    expect(remainingTime(held, after(2))?.meanS).toBe(118);
    expect(remainingTime(held, after(90))?.meanS).toBe(118);
    const resumed = missionAt(record(somePlan(), phase("flying"), phase(still), phase("hold"), phase("flying")), Infinity);
    expect(remainingTime(resumed, after(10))?.meanS).toBe(112);
  }
});

it("counts from a place that was chosen in hold", () => {
  const chosen = missionAt(record(phase("hold"), somePlan()), Infinity);
  expect(remainingTime(chosen, after(60))?.meanS).toBe(120);
});

it("is unknown when the planner gave no time, and over with the mission", () => {
  expect(remainingTime(missionAt(record(somePlan({ expected_time_s: null })), Infinity), after(0))).toBeNull();
  const ended = record(somePlan(), { kind: "mission_ended", outcome: "aborted", reason: "", mission_time_s: 1 });
  expect(remainingTime(missionAt(ended, Infinity), after(5))).toBeNull();
});
