import { expect, it } from "vitest";
import type { MissionEvent } from "../wire";
import { isTold } from "./told";

it("tells a searcher what happened outside, and not what was done at a desk", () => {
  const kinds = ["mission_started", "plan_chosen", "bearing_measured", "mission_ended", "truth_noted", "variant_kept", "mission_deleted"];
  expect(kinds.filter((kind) => isTold({ kind } as MissionEvent))).toEqual([
    "mission_started",
    "bearing_measured",
    "mission_ended",
    "truth_noted",
  ]);
});

it("tells of a checklist only when something failed", () => {
  const checked = (passed: boolean) => isTold({ kind: "preflight_checked", passed, checks: [] } as MissionEvent);
  expect([checked(true), checked(false)]).toEqual([false, true]);
});
