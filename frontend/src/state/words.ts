// The state of the mission as sentences.
import { type MessageKey, reasonText, t } from "../i18n";
import { formatClock, formatDuration } from "../units/quantities";
import type { CheckFact, MissionPhase } from "../wire";
import type { MissionView } from "./view";

export const phaseName = (phase: MissionPhase): string => t(`phase.${phase}` satisfies MessageKey);

export const checkName = (name: CheckFact["name"]): string => t(`check.${name}` satisfies MessageKey);

/** What the mission does, from its events alone: for review, for other languages, before the first status. */
export function stateWords(mission: MissionView, etaS: number | null): string {
  const number = mission.placeNumber ?? mission.nextPlaceNumber;
  const because = mission.ended?.fact.reason ?? mission.phaseReason;
  const reason = because ? reasonText(because) : phaseName(mission.phase);
  switch (mission.phase) {
    case "flying":
      return etaS === null ? t("state.flying", { number }) : t("state.flyingEta", { number, time: formatDuration(etaS) });
    case "planning":
      return t("state.planning", { number: mission.nextPlaceNumber });
    case "measuring":
      return mission.attempt > 1 ? t("state.measuringAgain", { number, attempt: mission.attempt }) : t("state.measuring", { number });
    case "draft":
      return t(mission.preflightPassed === false ? "state.refused" : "state.draft");
    case "ground":
    case "searching":
      return t("state.searching");
    case "ready":
    case "taking_off":
    case "waiting":
    case "hold":
    case "manual":
    case "returning":
    case "landing":
    case "done":
    case "aborted":
    case "failed":
      return t(`state.${mission.phase}` satisfies MessageKey, { number, reason });
  }
}

/** What the mission waits for before it goes on; null when it goes on by itself. */
export function waitsWords(mission: MissionView): string | null {
  switch (mission.phase) {
    case "waiting":
      return t("waits.waiting");
    case "hold":
      return t(mission.lost.vehicle ? "waits.vehicle" : "waits.hold");
    case "manual":
      return t("waits.manual");
    default:
      return null;
  }
}

export const reviewWords = (iso: string): string => t("state.review", { time: formatClock(iso) });
