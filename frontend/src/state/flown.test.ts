import { expect, it } from "vitest";
import type { MissionEvent, Recorded } from "../wire";
import { lastFlown } from "./flown";

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
