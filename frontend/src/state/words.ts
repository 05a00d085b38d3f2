// The state of the mission as sentences.
import { type MessageKey, reasonText, t } from "../i18n";
import { formatClock, formatDuration } from "../units/quantities";
import type { Authority, BearingSource, CheckFact, LinkName, MissionPhase, Reason, ReasonCode } from "../wire";
import type { WhoFlies } from "./craft";
import { isOver } from "./mission";
import type { MissionView } from "./view";

export const phaseName = (phase: MissionPhase): string => t(`phase.${phase}` satisfies MessageKey);

export const checkName = (name: CheckFact["name"]): string => t(`check.${name}` satisfies MessageKey);

const AUTOPILOTS = { px4: "PX4", ardupilot: "ArduPilot" } as const;

export const autopilotWords = (kind: keyof typeof AUTOPILOTS | "unknown"): string =>
  kind === "unknown" ? t("bar.unknown") : AUTOPILOTS[kind];

/** Who took a bearing. */
export function sourceName(source: BearingSource): string {
  switch (source.kind) {
    case "craft":
      return t("source.craft", { name: source.craft_id });
    case "import":
      return t("source.import");
    case "person":
      return source.name;
  }
}

/** What holds a craft for as long as a link is away. */
const HOLDING_LINK: Partial<Record<ReasonCode, LinkName>> = {
  no_console: "console",
  vehicle_link_lost: "vehicle",
  receiver_trouble: "receiver",
  payload_link_lost: "payload",
};

/**
 * Why the craft stands still, unless it stands on the ground or its failsafe flies, which may have begun, or ended, since it
 * holds; a link that is back since is said to be back.
 */
function holdWords({ phaseReason, lost, alerts, craftId, authority }: MissionView, reason: string): string {
  const open = (topic: "vehicle" | "ground") =>
    alerts.find((alert) => alert.topic === topic && alert.craftId === craftId && !alert.cleared)?.reason;
  const failsafe = authority.who === "failsafe";
  const stopped = failsafe && authority.given_back;
  const told = open("vehicle");
  const why = stopped && told ? reasonText(told) : null;
  if (failsafe && !stopped && told?.code === "failsafe_flies") return reasonText(told);
  if (authority.failsafe_landed || open("ground")) return t("state.ground");
  if (!stopped && phaseReason?.code === "failsafe_flies") return reason;
  if (failsafe && !stopped) return whoFlies("failsafe", authority.mode ?? "", false);
  const link = phaseReason && HOLDING_LINK[phaseReason.code];
  return !why && link && !lost[link]
    ? t("state.hold.back", { link: t(`link.${link}` satisfies MessageKey) })
    : t("state.hold", { reason: why ?? reason });
}

/** Who flies; mode: the autopilot's name of what it flies in. */
export function whoFlies(who: Authority["who"], mode: string, perhapsFailsafe: boolean): string {
  switch (who) {
    case "pilot":
      return t(perhapsFailsafe ? "control.perhapsFailsafe" : "control.pilot", { mode });
    case "failsafe":
      return t("control.failsafe", { mode });
    case "ours":
      return t("control.crossfix");
    case "nobody":
      return t("control.nobody");
  }
}

/** The same with what only an authority knows: an order that undid the switch, a vehicle that was given back. */
export function authorityWords(authority: WhoFlies, mode: string): string {
  if (authority.who === "pilot" && authority.undone) return t("control.undone");
  if (authority.who === "pilot" && authority.given_back)
    return t(authority.perhaps_failsafe ? "control.perhapsGivenBack" : "control.givenBack");
  return whoFlies(authority.who, mode, authority.perhaps_failsafe);
}

/** Whether the nose swings on the way: what the server asks of it, too. */
function noseSwings(spec: MissionView["spec"]): boolean {
  if (!spec?.sensor.swing_on_the_way || !spec.sensor.listen_on_the_way) return false;
  return spec.sensor.bearing_errors === "joint" && spec.emitters.some(({ movement }) => movement.kind === "still");
}

/** Whether no turn is foreseen at the next place: after the first whole turn, of a mission that never stops. */
function passesNext({ spec, bearings }: MissionView): boolean {
  return spec?.sensor.never_stop === true && bearings.some(({ fact, excluded }) => fact.source.kind === "craft" && !excluded);
}

/** What the nose does on the way; null: it keeps still. */
export function noseWords(mission: MissionView): string | null {
  if (mission.phase !== "flying" || !noseSwings(mission.spec)) return null;
  return t(passesNext(mission) ? "state.noTurnNext" : "state.noseSwings");
}

/** What the mission does, from its events alone: for review, for other languages, before the first status. */
export function stateWords(mission: MissionView, etaS: number | null): string {
  const number = mission.placeNumber ?? mission.nextPlaceNumber;
  const because = isOver(mission.phase) ? mission.ended?.fact.reason : mission.phaseReason;
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
    case "hold":
      return holdWords(mission, reason);
    case "ready":
    case "ground":
    case "searching":
    case "taking_off":
    case "waiting":
    case "manual":
    case "returning":
    case "landing":
    case "done":
    case "aborted":
    case "failed":
      return t(`state.${mission.phase}` satisfies MessageKey, { number, reason });
  }
}

/** What the mission waits for before it goes on; null when it goes on by itself. refused: why it cannot be resumed now. */
export function waitsWords(mission: MissionView, refused: Reason | null = null): string | null {
  switch (mission.phase) {
    case "waiting":
      return t("waits.waiting");
    case "hold":
      return t(mission.lost.vehicle ? "waits.vehicle" : "waits.hold");
    case "manual":
      return t(mission.authority.given_back && !refused ? "waits.hold" : "waits.manual");
    default:
      return null;
  }
}

export const reviewWords = (iso: string): string => t("state.review", { time: formatClock(iso) });
