import { expect, it } from "vitest";
import type { MissionEvent, Recorded } from "../wire";
import { isTold, lastFlown } from "./flown";

const told = (...kinds: string[]) =>
  kinds.map((kind, i) => ({ seq: i + 1, at_utc: `2026-11-22T10:0${i}:00Z`, mission_id: "m", event: { kind } as MissionEvent }) as Recorded);

it("ends a search with its last event, whatever is done with its record later", () => {
  const all = told("mission_drafted", "mission_started", "mission_ended", "truth_noted", "variant_kept", "mission_labelled");
  expect(lastFlown(all)?.event.kind).toBe("mission_ended");
});

it("has an end before anything was flown", () => {
  expect(lastFlown(told("mission_labelled"))?.seq).toBe(1);
  expect(lastFlown([])).toBeUndefined();
});

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
