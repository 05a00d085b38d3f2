import { expect, it } from "vitest";
import type { MissionEvent } from "../wire";
import { ended, phase, record, somePlan } from "../wire/examples";
import { missionAt } from "./mission";
import { remainingTime } from "./timeLeft";
import { viewOf } from "./view";

const seen = (...events: MissionEvent[]) => viewOf(missionAt(record(...events), Infinity));

/** Seconds after the plan, which is the first event. */
const after = (seconds: number) => Date.UTC(2026, 0, 1, 12, 0, 0) + 1000 * seconds;
const planned = seen(somePlan());

it("counts down from the plan and stops at nothing", () => {
  expect(remainingTime(planned, after(0))).toEqual({ meanS: 120, worstS: 200 });
  expect(remainingTime(planned, after(50))).toEqual({ meanS: 70, worstS: 150 });
  expect(remainingTime(planned, after(150))).toEqual({ meanS: 0, worstS: 50 });
});

it("stands still in hold, under the pilot and while it waits for the operator", () => {
  for (const still of ["hold", "manual", "waiting"] as const) {
    const held = seen(somePlan(), phase("flying"), phase(still));
    expect(remainingTime(held, after(2))?.meanS).toBe(118);
    expect(remainingTime(held, after(90))?.meanS).toBe(118);
    const resumed = seen(somePlan(), phase("flying"), phase(still), phase("hold"), phase("flying"));
    expect(remainingTime(resumed, after(10))?.meanS).toBe(112);
  }
});

it("counts from a place that was chosen in hold", () => {
  const chosen = seen(phase("hold"), somePlan());
  expect(remainingTime(chosen, after(60))?.meanS).toBe(120);
});

it("is unknown when the planner gave no time, and over with the mission", () => {
  expect(remainingTime(seen(somePlan({ expected_time_s: null })), after(0))).toBeNull();
  expect(remainingTime(seen(somePlan(), ended("aborted")), after(5))).toBeNull();
});
