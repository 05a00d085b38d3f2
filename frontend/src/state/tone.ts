// What a state asks of whoever looks: the same colours in the bar and in the list of missions.
import type { MissionPhase } from "../wire";

/** working: it goes on by itself; waiting: for a person; found: what it was flown for; broken: ended before. */
export type Tone = "idle" | "working" | "waiting" | "found" | "broken";

export function toneOfPhase(phase: MissionPhase): Tone {
  switch (phase) {
    case "draft":
    case "ready":
    case "ground":
    case "searching":
    case "done":
      return "idle";
    case "taking_off":
    case "planning":
    case "flying":
    case "measuring":
    case "returning":
    case "landing":
      return "working";
    case "waiting":
    case "hold":
    case "manual":
      return "waiting";
    case "aborted":
    case "failed":
      return "broken";
  }
}

/** Of a mission in the list, by its outcome once it has one. */
export function toneOfMission(phase: MissionPhase, outcome: string | null): Tone {
  if (outcome === "localized") return "found";
  return toneOfPhase(phase);
}
