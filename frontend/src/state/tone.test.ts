import { expect, it } from "vitest";
import type { MissionPhase } from "../wire";
import { inFlight } from "./mission";
import { toneOfMission, toneOfPhase } from "./tone";

const PHASES: readonly MissionPhase[] = [
  "draft",
  "ready",
  "ground",
  "searching",
  "taking_off",
  "planning",
  "waiting",
  "flying",
  "measuring",
  "hold",
  "manual",
  "returning",
  "landing",
  "done",
  "aborted",
  "failed",
];

it("exactly what is in flight works or waits for a person", () => {
  const busy = PHASES.filter((phase) => ["working", "waiting"].includes(toneOfPhase(phase)));
  expect(busy).toEqual(PHASES.filter(inFlight));
});

it("a mission that found its emitter says so, whatever came after", () => {
  expect(toneOfMission("done", "localized")).toBe("found");
  expect(toneOfMission("done", "not_localized")).toBe("idle");
  expect(toneOfMission("failed", "failed")).toBe("broken");
});
