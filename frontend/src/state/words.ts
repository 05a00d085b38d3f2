// The state of the mission and its events as sentences.
import { t, told, toldName, toldReason, type MessageKey } from "../i18n";
import { formatBearing, formatClock, formatDuration, formatLength, formatNumber, type UnitSystem } from "../units/quantities";
import type { MissionEvent, Phase, Recorded } from "../wire";
import type { MissionState } from "./mission";

export const phaseName = (phase: Phase): string => t(`phase.${phase}` satisfies MessageKey);

/** What the mission does, from its events alone: for review, for other languages, before the first status. */
export function stateWords(mission: MissionState, etaS: number | null): string {
  const number = mission.placeNumber ?? mission.bearings.length + 1;
  const reason = mission.phaseReason ? told(mission.phaseReason) : phaseName(mission.phase);
  switch (mission.phase) {
    case "flying":
      return etaS === null
        ? t("state.flying", { number })
        : t("state.flyingEta", { number, time: formatDuration(etaS) });
    case "planning":
      return t("state.planning", { number: mission.bearings.length + 1 });
    case "measuring":
      return mission.attempt > 1
        ? t("state.measuringAgain", { number, attempt: mission.attempt })
        : t("state.measuring", { number });
    case "done":
      return t("state.done", { reason: mission.ended ? told(mission.ended.fact.reason) : reason });
    case "draft":
      return t(mission.preflightPassed === false ? "state.refused" : "state.draft");
    case "ready":
    case "taking_off":
    case "waiting":
    case "hold":
    case "manual":
    case "returning":
    case "landing":
    case "aborted":
    case "failed":
      return t(`state.${mission.phase}` satisfies MessageKey, { number, reason });
  }
}

/** What the mission waits for before it goes on; null when it goes on by itself. */
export function waitsWords(mission: MissionState): string | null {
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

/** How much an event matters to somebody who skims. */
export function isMain(event: MissionEvent): boolean {
  switch (event.kind) {
    case "phase_changed":
    case "command_accepted":
    case "sweep_started":
    case "alert_acknowledged":
    case "alert_cleared":
    case "belief_updated":
      return false;
    default:
      return true;
  }
}

export type EventTone = "bearing" | "decision" | "alert" | "mode" | "other";

export function toneOf(event: MissionEvent): EventTone {
  switch (event.kind) {
    case "bearing_measured":
    case "sweep_rejected":
    case "bearing_excluded":
    case "recording_imported":
      return "bearing";
    case "plan_chosen":
    case "plan_vetoed":
      return "decision";
    case "alert_raised":
    case "link_lost":
    case "safety_vetoed":
    case "command_refused":
      return "alert";
    case "phase_changed":
    case "control_taken":
    case "control_released":
    case "hold_ordered":
    case "resume_ordered":
    case "return_ordered":
    case "abort_ordered":
    case "automatic_changed":
    case "area_changed":
    case "mission_started":
    case "mission_ended":
      return "mode";
    default:
      return "other";
  }
}

/** An operator needs no reason; the mission tells its own. */
function orderWords(order: "hold" | "return" | "abort", { by, reason }: { by: string; reason: string }): string {
  const words = t(`event.${order}_ordered` satisfies MessageKey, { by: told(by) });
  return reason === "ordered" ? words : `${words}: ${told(reason)}`;
}

export function eventWords({ event }: Recorded, units: UnitSystem): string {
  switch (event.kind) {
    case "mission_drafted":
      return t("event.mission_drafted");
    case "mission_edited":
      return t("event.mission_edited");
    case "area_changed":
      return t("event.area_changed", { by: told(event.by) });
    case "preflight_checked":
      return event.passed
        ? t("event.preflight_passed")
        : t("event.preflight_failed", {
            names: event.checks
              .filter((c) => !c.ok && c.blocking)
              .map((c) => toldName(c.name))
              .join(", "),
          });
    case "mission_started":
      return t("event.mission_started", { by: told(event.by) });
    case "phase_changed":
      return event.reason
        ? t("event.phase_changed", { phase: phaseName(event.after), reason: told(event.reason) })
        : t("event.phase_changed.plain", { phase: phaseName(event.after) });
    case "took_off":
      return t("event.took_off", { height: formatLength(event.altitude_relative_m, units) });
    case "plan_chosen":
      return t("event.plan_chosen", { number: event.place_number, reason: told(event.reason) });
    case "plan_vetoed":
      return t("event.plan_vetoed", { by: told(event.by) });
    case "flight_started":
      return t("event.flight_started", { number: event.place_number });
    case "place_reached":
      return t("event.place_reached", { number: event.place_number, time: formatDuration(event.flight_time_s) });
    case "sweep_started":
      return event.attempt > 1
        ? t("event.sweep_again", { number: event.place_number, attempt: event.attempt })
        : t("event.sweep_started", { number: event.place_number });
    case "sweep_rejected":
      return t("event.sweep_rejected", { quality: formatNumber(event.quality, 2), reason: told(event.reason) });
    case "bearing_measured":
      return t("event.bearing_measured", {
        bearing: formatBearing(event.bearing_deg),
        sigma: formatNumber(event.sigma_deg, 1),
        number: event.place_number,
        quality: formatNumber(event.quality, 2),
      });
    case "antenna_checked":
      return t(event.check.ok ? "event.antenna_ok" : "event.antenna_wrong", { detail: told(event.check.detail) });
    case "recording_imported":
      return t("event.recording_imported", { name: event.filename, count: event.sweep_ids.length, by: told(event.by) });
    case "bearing_excluded":
      return t("event.bearing_excluded", { by: told(event.by), reason: told(event.reason) });
    case "belief_updated":
      if (!event.estimate || (!event.consistent && !event.localized)) return t("event.belief_inconsistent");
      if (event.localized && event.contradicting.length > 0)
        return t("event.belief_localized_against", {
          against: event.contradicting.length,
          bearings: event.bearings,
          rmse: formatLength(event.estimate.expected_rmse_m, units),
        });
      return event.localized
        ? t("event.belief_localized", { rmse: formatLength(event.estimate.expected_rmse_m, units) })
        : t("event.belief_updated", {
            rmse: formatLength(event.estimate.expected_rmse_m, units),
            reason: event.not_yet.map(toldReason).join("; "),
          });
    case "hold_ordered":
      return orderWords("hold", event);
    case "resume_ordered":
      return t("event.resume_ordered", { by: told(event.by) });
    case "return_ordered":
      return orderWords("return", event);
    case "abort_ordered":
      return orderWords("abort", event);
    case "automatic_changed":
      return t(event.automatic ? "event.automatic_on" : "event.automatic_off", { by: told(event.by) });
    case "control_taken":
      return t("event.control_taken", { mode: event.mode });
    case "control_released":
      return t("event.control_released", { by: told(event.by) });
    case "command_accepted":
      return t("event.command_accepted", { command: event.command, by: told(event.by) });
    case "command_refused":
      return t("event.command_refused", { command: event.command, reason: told(event.reason) });
    case "safety_vetoed":
      return t("event.safety_vetoed", { detail: told(event.detail) });
    case "link_lost":
      return t("event.link_lost", { link: t(`link.${event.link}` satisfies MessageKey), detail: told(event.detail) });
    case "link_restored":
      return t("event.link_restored", {
        link: t(`link.${event.link}` satisfies MessageKey),
        time: formatDuration(event.outage_s),
      });
    case "alert_raised":
      return t("event.alert_raised", { level: t(`alerts.${event.level}` satisfies MessageKey), text: told(event.text) });
    case "alert_acknowledged":
      return t("event.alert_acknowledged", { by: told(event.by) });
    case "alert_cleared":
      return t("event.alert_cleared");
    case "server_restarted":
      return t("event.server_restarted", { detail: told(event.detail) });
    case "mission_ended":
      return t("event.mission_ended", {
        outcome: t(`outcome.${event.outcome}` satisfies MessageKey),
        reason: told(event.reason),
      });
  }
}

export const reviewWords = (iso: string): string => t("state.review", { time: formatClock(iso) });
