// The events of a mission as sentences.
import { type MessageKey, personName, reasonText, t } from "../i18n";
import { formatBearing, formatDuration, formatLength, formatNumber, type UnitSystem } from "../units/quantities";
import type { BeliefUpdated, Command, EmitterSpec, EventOf, MissionEvent, Recorded } from "../wire";
import { emitterName, namingEmitter } from "./emitterName";
import { importanceWords } from "./importance";
import { wayWords } from "./wayWords";
import { authorityWords, checkName, phaseName, sourceName } from "./words";

/** null: the mission by itself. */
const byWords = (by: string | null): string => (by === null ? t("by.mission") : personName(by));

const COMMANDS: Record<Command["kind"], MessageKey> = {
  start: "command.start",
  hold: "command.hold",
  resume: "command.resume",
  return: "command.return",
  land: "command.land",
  abort: "command.abort",
  keep_holding: "command.keep_holding",
  override: "command.override",
  accept: "command.accept",
  veto: "command.veto",
  set_automatic: "command.set_automatic",
  change_area: "command.change_area",
  exclude_bearing: "command.exclude_bearing",
  include_bearing: "command.include_bearing",
  mute_source: "command.mute_source",
  set_priorities: "command.set_priorities",
  acknowledge_alert: "command.acknowledge_alert",
  take_control: "command.take_control",
  ask_control: "command.ask_control",
  give_control: "command.give_control",
  keep_control: "command.keep_control",
  release_control: "command.release_control",
};

/** A recording of a later server may hold a command that this page does not know. */
const commandName = (command: string): string => (command in COMMANDS ? t(COMMANDS[command as Command["kind"]]) : command);

/** An operator's order says all by itself; the mission tells its reason. */
function orderWords({ kind, by, reason }: EventOf<"hold_ordered" | "return_ordered" | "land_ordered">): string {
  const words = t(`event.${kind}` satisfies MessageKey, { by: byWords(by) });
  return reason ? `${words}: ${reasonText(reason)}` : words;
}

function controlWords({ authority, by }: EventOf<"authority_changed">): string {
  if (by !== null) return t("event.control_taken_back", { by: byWords(by) });
  return authorityWords(authority, authority.mode ?? t("control.sticks"));
}

function beliefWords({ estimate, consistent, localized, contradicting, bearings, not_yet }: BeliefUpdated, units: UnitSystem): string {
  if (!estimate || (!consistent && !localized)) return t("event.belief_inconsistent");
  const rmse = formatLength(estimate.expected_rmse_m, units);
  if (!localized) return t("event.belief_updated", { rmse, reason: not_yet.map(reasonText).join(" ") });
  const against = contradicting.length;
  return against > 0 ? t("event.belief_localized_against", { against, bearings, rmse }) : t("event.belief_localized", { rmse });
}

/** emitters: all that the mission looks for; with several, an event says whom it is about. */
export function eventWords({ event }: Recorded, units: UnitSystem, emitters: readonly EmitterSpec[]): string {
  const about = "emitter_id" in event && emitters.length > 1 ? event.emitter_id : null;
  const words =
    event.kind === "priorities_changed"
      ? t("event.priorities_changed", { by: byWords(event.by), order: importanceWords(emitters, event.priorities) })
      : wordsOf(event.kind === "alert_raised" ? { ...event, reason: namingEmitter(emitters, event.reason) } : event, units);
  return about === null ? words : `${emitterName(emitters, about)}: ${words}`;
}

function wordsOf(event: Exclude<MissionEvent, EventOf<"priorities_changed">>, units: UnitSystem): string {
  switch (event.kind) {
    case "mission_drafted":
      return t("event.mission_drafted");
    case "mission_edited":
      return t("event.mission_edited");
    case "area_changed":
      return t("event.area_changed", { by: byWords(event.by) });
    case "preflight_checked":
      return event.passed
        ? t("event.preflight_passed")
        : t("event.preflight_failed", {
            names: event.checks
              .filter((c) => !c.ok && c.blocking)
              .map((c) => checkName(c.name))
              .join(", "),
          });
    case "mission_started":
      return t("event.mission_started", { by: byWords(event.by) });
    case "nets_noted":
      return t("event.nets_noted");
    case "nets_hung":
      return t("event.nets_hung");
    case "nets_put_back":
      return t(event.whole ? "event.nets_put_back" : "event.nets_left");
    case "phase_changed":
      return t("event.phase_changed", { phase: phaseName(event.after), reason: reasonText(event.reason) });
    case "took_off":
      return t("event.took_off", { height: formatLength(event.altitude_relative_m, units) });
    case "plan_chosen":
      if (event.source === "operator") return t("event.plan_chosen.operator", { number: event.place_number, by: byWords(event.by) });
      return t("event.plan_chosen", { number: event.place_number, reason: reasonText(event.reason) });
    case "plan_vetoed":
      return t("event.plan_vetoed", { by: byWords(event.by) });
    case "place_refused":
      return t("event.place_refused", { number: event.place_number, reason: reasonText(event.reason) });
    case "flight_started":
      return t("state.flying", { number: event.place_number });
    case "place_reached":
      return t("event.place_reached", { number: event.place_number, time: formatDuration(event.flight_time_s) });
    case "place_passed":
      return t("event.place_passed", { number: event.place_number, reason: reasonText(event.reason) });
    case "sweep_started":
      return event.attempt > 1
        ? t("event.sweep_again", { number: event.place_number, attempt: event.attempt })
        : t("event.sweep_started", { number: event.place_number });
    case "sweep_rejected":
      return t("event.sweep_rejected", { quality: formatNumber(event.quality, 2), reason: reasonText(event.reason) });
    case "bearing_measured":
      if (event.source.kind === "person") {
        const told = { name: event.source.name, bearing: formatBearing(event.bearing_deg), sigma: formatNumber(event.sigma_deg, 1) };
        return [t("event.bearing_reported", told), ...event.remarks.map(reasonText)].join(" ");
      }
      return t("event.bearing_measured", {
        bearing: formatBearing(event.bearing_deg),
        sigma: formatNumber(event.sigma_deg, 1),
        number: event.place_number,
        quality: event.sweep_id ? formatNumber(event.quality, 2) : "–",
      });
    case "heard_on_the_way":
      return wayWords(event);
    case "antenna_checked":
      return t(event.check.ok ? "event.antenna_ok" : "event.antenna_wrong", { detail: reasonText(event.check.reason) });
    case "recording_imported":
      return event.sweep_ids.length === 0
        ? t("event.bearings_imported", { name: event.filename, by: byWords(event.by) })
        : t("event.recording_imported", { name: event.filename, count: event.sweep_ids.length, by: byWords(event.by) });
    case "bearing_excluded":
      if (event.on_the_way) return t("event.way_excluded", { by: byWords(event.by) });
      if (!event.heard) return t("event.silence_excluded", { by: byWords(event.by) });
      return event.reason
        ? t("event.bearing_excluded", { by: byWords(event.by), reason: event.reason })
        : t("event.bearing_excluded.plain", { by: byWords(event.by) });
    case "bearing_included":
      return t("event.bearing_included", { by: byWords(event.by) });
    case "source_mute_changed":
      return t(event.muted ? "event.source_muted" : "event.source_unmuted", { source: sourceName(event.source), by: byWords(event.by) });
    case "belief_updated":
      return beliefWords(event, units);
    case "hold_ordered":
    case "land_ordered":
    case "return_ordered":
      return orderWords(event);
    case "resume_ordered":
      return t("event.resume_ordered", { by: byWords(event.by) });
    case "order_tried":
      return t(event.way === event.order ? "event.order_tried" : "event.order_tried.instead", {
        order: t(`command.${event.order}`),
        way: t(`command.${event.way}`),
      });
    case "order_not_done":
      return t("event.order_not_done", {
        order: t(`command.${event.order}`),
        reason: reasonText(event.reason),
        way: t(`command.${event.next_way}`),
      });
    case "order_done":
      return t(event.way === event.order ? "event.order_done" : "event.order_done.instead", {
        order: t(`command.${event.order}`),
        way: t(`command.${event.way}`),
      });
    case "abort_ordered":
      return t("event.abort_ordered", { by: byWords(event.by) });
    case "battery_countdown_started":
      return t("event.battery_countdown_started", { time: formatDuration(event.seconds), reason: reasonText(event.reason) });
    case "battery_countdown_stopped":
      return t("event.battery_countdown_stopped", { by: byWords(event.by) });
    case "automatic_changed":
      return t(event.automatic ? "event.automatic_on" : "event.automatic_off", { by: byWords(event.by) });
    case "authority_changed":
      return controlWords(event);
    case "command_accepted":
      return t("event.command_accepted", { command: commandName(event.command), by: byWords(event.by) });
    case "command_refused":
      return t("event.command_refused", { command: commandName(event.command), reason: reasonText(event.reason) });
    case "control_changed":
      return t(`event.control_changed.${event.way}` satisfies MessageKey, { name: event.holder?.name ?? "", by: event.by });
    case "control_asked":
      return t("event.control_asked", { by: event.by });
    case "control_kept":
      return t("event.control_kept", { by: event.by });
    case "safety_vetoed":
      return t("event.safety_vetoed", { reason: reasonText(event.reason) });
    case "link_lost":
      return t("event.link_lost", { link: t(`link.${event.link}` satisfies MessageKey), reason: reasonText(event.reason) });
    case "link_restored":
      return t("event.link_restored", {
        link: t(`link.${event.link}` satisfies MessageKey),
        time: formatDuration(event.outage_s),
      });
    case "alert_raised":
      return t("event.alert_raised", { level: t(`alerts.${event.level}` satisfies MessageKey), text: reasonText(event.reason) });
    case "alert_acknowledged":
      return t("event.alert_acknowledged", { by: byWords(event.by) });
    case "alert_cleared":
      return t("event.alert_cleared");
    case "server_restarted":
      return t("event.server_restarted");
    case "truth_noted":
      return t(event.place === null ? "event.truth_nowhere" : "event.truth_noted", { by: event.by });
    case "mission_labelled":
      return t("event.mission_labelled", { by: event.by });
    case "mission_deleted":
      return t("event.mission_deleted", { by: event.by });
    case "variant_kept":
      return t("event.variant_kept", { name: event.name, by: event.by });
    case "variant_dropped":
      return t("event.variant_dropped", { name: event.name, by: event.by });
    case "mission_brought_in":
      return t("event.mission_brought_in", { by: event.by });
    case "mission_restored":
      return t("event.mission_restored", { by: event.by });
    case "mission_ended":
      // this reason begins with the outcome
      if (event.reason.code === "not_localized") return t("event.mission_ended_reason", { reason: reasonText(event.reason) });
      return t("event.mission_ended", {
        outcome: t(`outcome.${event.outcome}` satisfies MessageKey),
        reason: reasonText(event.reason),
      });
  }
}
