// Always there, loads first, needs no WebGL: abort, hold, return, state in words, links, alerts.
import { useEffect, useRef, useState } from "preact/hooks";
import { landingArmed } from "../commands/landing";
import { SlideToConfirm } from "../commands/SlideToConfirm";
import { send } from "../commands/send";
import { resume, sendUrgent, type Urgent, urgent } from "../commands/urgent";
import { type MessageKey, reasonText, t } from "../i18n";
import { ageS, type Freshness, freshness, OLD_AFTER_S } from "../state/age";
import { nowMs } from "../state/clock";
import { live, serverNowMs, source } from "../state/connection";
import { NOBODY, pilotHas } from "../state/craft";
import { flying } from "../state/flying";
import { distanceM, lonLat } from "../state/geometry";
import { craftStatus, telemetry } from "../state/heard";
import { cursor, events } from "../state/moment";
import { toggle } from "../state/overlay";
import { resumeRefused } from "../state/resume";
import { go, missionAddress } from "../state/route";
import { me } from "../state/session";
import { mission, shownTimeMs } from "../state/shown";
import { toneOfPhase } from "../state/tone";
import { vehicle } from "../state/vehicle";
import { authorityWords, noseWords, reviewWords, stateWords, waitsWords } from "../state/words";
import { formatAge, formatDuration } from "../units/quantities";
import { AlertsButton } from "./AlertsButton";
import { ControlAsked, ControlButton } from "./ControlButton";
import { Menu } from "./Menu";
import { ProblemNote } from "./ProblemNote";

function UrgentButton({ kind }: { kind: Urgent }) {
  const target = flying.value;
  const able = target !== null && (kind !== "abort" || target.id !== null);
  const pilots = able && target.phase === "manual" && kind !== "abort";
  return (
    <button
      type="button"
      class={`urgent urgent-${kind} ${pilots ? "refused-now" : ""}`}
      data-testid={kind}
      disabled={!able}
      title={t(pilots ? "bar.pilotHas" : able ? (`bar.${kind}.hint` satisfies MessageKey) : target ? "bar.noMission" : "bar.nothingFlies")}
      onClick={() => target && void sendUrgent(target, kind)}
    >
      {t(`bar.${kind}` satisfies MessageKey)}
    </button>
  );
}

/** Where it is: what is below is not known, so it takes a slide. */
function Landing() {
  const target = flying.value;
  const offered = target !== null && target.phase !== "manual";
  const disarm = () => {
    landingArmed.value = false;
  };
  useEffect(() => disarm, [offered]);
  if (!target || !offered) return null;
  if (!landingArmed.value) {
    return (
      <button type="button" class="urgent" data-testid="land" title={t("bar.land.hint")} onClick={() => (landingArmed.value = true)}>
        {t("bar.land")} …
      </button>
    );
  }
  return (
    <div class="bar-slide">
      <SlideToConfirm
        label={t("bar.land.slide")}
        testId="land-slider"
        onConfirm={() => {
          disarm();
          void sendUrgent(target, "land");
        }}
        onCancel={disarm}
      />
    </div>
  );
}

function Resume() {
  const [armed, setArmed] = useState(false);
  const target = flying.value;
  const canResume = (target?.phase === "hold" && target.id !== null) || target?.phase === "manual";
  const refused = resumeRefused.value;
  /** Its page, where that is not shown: who steers it is heard only there, and signed in nothing is resumed without. */
  const there = me.value && target?.id && target.id !== source.value?.missionId && missionAddress(target.id);
  const offered = canResume && refused === null && !there;
  useEffect(() => void (offered || setArmed(false)), [offered]);
  if (!target || !canResume) return null;
  if (!armed || !offered) {
    return (
      <button
        type="button"
        class="resume"
        data-testid="resume"
        disabled={refused !== null}
        title={refused ? reasonText(refused) : t(there ? "bar.otherFlies.open" : "bar.resume")}
        onClick={() => (there ? go(there) : setArmed(true))}
      >
        {t("bar.resume")}
      </button>
    );
  }
  return (
    <div class="bar-slide">
      <SlideToConfirm
        label={t(target.phase === "manual" ? "bar.resume.slideManual" : "bar.resume.slide")}
        testId="resume-slider"
        onConfirm={() => {
          setArmed(false);
          void resume(target);
        }}
        onCancel={() => setArmed(false)}
      />
    </div>
  );
}

interface Reading {
  label: string;
  testId: string;
  value: string;
  age: number | null;
  state: Freshness;
  alert?: "warning" | "caution" | null;
  more?: string;
}

function Indicator({ label, testId, value, age, state, alert, more }: Reading) {
  return (
    <span class={`indicator ${state} ${alert ?? ""}`} data-testid={testId} data-state={state}>
      <span class="indicator-label">{label}</span>
      <span class="indicator-value">{state === "gone" ? "–" : value}</span>
      <span class="indicator-more">
        {state === "old" && age !== null ? t("bar.age", { age: formatAge(age) }) : state === "fresh" ? more : ""}
      </span>
    </span>
  );
}

function Indicators() {
  const now = nowMs.value;
  const { link, lastMessageMs, unreadable } = live.value;
  const heard = telemetry.value?.value;
  const at = telemetry.value?.atMs ?? null;
  const craft = craftStatus.value;
  const silence = ageS(0, lastMessageMs ?? link.sinceMs, now) ?? 0;
  const linkAlert = link.state === "closed" || silence > 2 * OLD_AFTER_S ? "warning" : null;
  const batteryAge = ageS(heard?.battery_age_s, at, now);
  const gpsAge = ageS(heard?.position_age_s, at, now);
  const connectedAge = ageS(0, at, now);
  const receiverAge = ageS(craft ? 0 : null, craft?.atMs ?? null, now);
  const needed = craft?.value.battery_to_return_percent ?? null;
  const battery = heard?.battery_percent ?? null;
  const receiver = craft?.value.receiver ?? "off";
  const power = craft?.value.receiver_power_db ?? null;
  const reserve = live.value.mission.spec?.flight.reserve_battery_percent ?? 25;
  const vehicleState = heard === undefined ? "bar.vehicle.never" : heard.connected ? "bar.vehicle.ok" : "bar.vehicle.lost";
  const poorFix = heard?.gps_fix != null && /no|2d|none/i.test(heard.gps_fix);
  return (
    <button type="button" class="indicators" data-testid="indicators" title={t("instruments.title")} onClick={() => toggle("instruments")}>
      <Indicator
        label={t("bar.link")}
        testId="link"
        value={link.state === "closed" ? t("bar.link.closed", { age: formatAge(silence) }) : t(`bar.link.${link.state}`)}
        age={silence}
        state="fresh"
        alert={linkAlert}
        more={unreadable > 0 ? t("bar.unreadable", { count: unreadable }) : ""}
      />
      <Indicator
        label={t("bar.vehicle")}
        testId="vehicle-link"
        value={t(vehicleState)}
        age={connectedAge}
        state={freshness(connectedAge)}
        alert={heard && !heard.connected ? "warning" : null}
        more={heard?.mode ?? ""}
      />
      <Indicator
        label={t("bar.gps")}
        testId="gps"
        value={
          heard?.satellites != null
            ? t("bar.gps.satellites", { fix: heard.gps_fix ?? "?", count: heard.satellites })
            : (heard?.gps_fix ?? t("bar.unknown"))
        }
        age={gpsAge}
        state={freshness(gpsAge)}
        alert={poorFix ? "caution" : null}
      />
      <Indicator
        label={t("bar.battery")}
        testId="battery"
        value={battery === null ? t("bar.unknown") : `${Math.round(battery)} %`}
        age={batteryAge}
        state={freshness(batteryAge)}
        alert={battery === null ? null : battery < (needed ?? 0) ? "warning" : battery < reserve + (needed ?? 0) ? "caution" : null}
        more={
          needed === null || battery === null
            ? ""
            : battery < needed
              ? t("bar.battery.tooLittle", { percent: Math.ceil(needed) })
              : t("bar.battery.toReturn", { percent: Math.ceil(needed), left: Math.floor(battery - needed) })
        }
      />
      <Indicator
        label={t("bar.receiver")}
        testId="receiver"
        value={t(`bar.receiver.${receiver}`)}
        age={receiverAge}
        state={freshness(receiverAge)}
        alert={receiver === "lost" ? "warning" : receiver === "silent" ? "caution" : null}
        more={power === null ? "" : `${power.toFixed(0)} dB`}
      />
    </button>
  );
}

/**
 * Who flies, by the authority that the mission's facts fold to: a pilot has control until they give it back or a failsafe
 * shows, whatever was heard last. Where the facts name no pilot, as the vehicle tells it now.
 */
function controlWords(): string {
  const { authority, craftId, phase } = mission.value;
  const heard = telemetry.value?.value;
  const past = cursor.value !== null && craftId !== null;
  const failsafe = !past && heard?.who === "failsafe";
  const pilots = pilotHas(authority) && !failsafe && (phase === "manual" || !authority.given_back);
  const who = pilots ? "pilot" : past ? authority.who : (heard?.who ?? null);
  if (who === null) return t("control.unknown");
  const known = pilots || past ? authority : NOBODY;
  return authorityWords({ ...known, who }, known.mode ?? heard?.mode ?? t("control.sticks"));
}

/** Seconds until the place that is flown to is reached, as the crow flies. */
function etaS(): number | null {
  const { plan, spec, phase } = mission.value;
  const { at, speedMs } = vehicle.value;
  if (phase !== "flying" || !plan || !at || !spec) return null;
  return distanceM(at, lonLat(plan.fact.place)) / Math.max(speedMs ?? 0, spec.flight.speed_m_s);
}

/** What flies is not what is shown: said in the bar itself, since it lasts and a note would lie over the page. */
function Elsewhere() {
  const flown = flying.value;
  if (!flown || (flown.id !== null && flown.id === live.value.mission.missionId)) return null;
  return flown.id === null ? (
    <div class="elsewhere" data-testid="no-mission">
      {t("bar.noMissionFlies")}
    </div>
  ) : (
    <div class="elsewhere" data-testid="other-flies">
      {live.value.mission.missionId !== null && t("bar.otherFlies")} <a href={missionAddress(flown.id)}>{t("bar.otherFlies.open")}</a>
    </div>
  );
}

function Words() {
  const now = nowMs.value;
  const { link, lastMessageMs, hello } = live.value;
  const silence = ageS(0, lastMessageMs ?? link.sinceMs, now) ?? 0;
  const shown = mission.value;
  const reviewed = cursor.value === null ? null : events.value.findLast((e) => e.seq <= cursor.value!);

  const elsewhere = flying.value?.id === null ? "state.noMission" : flying.value ? "state.otherFlies" : "state.none";
  const doing = shown.missionId ? stateWords(shown, etaS()) : t(elsewhere);
  const past = reviewed ? reviewWords(reviewed.at_utc) : source.value?.happensNow === false && t("state.recording");
  const words = past ? `${past}: ${doing}` : doing;
  const lost = cursor.value === null && (link.state === "closed" || silence > 2 * OLD_AFTER_S) && hello !== null;

  const startedMs = shown.startedAt ? Date.parse(shown.startedAt) : null;
  const waits = waitsWords(shown, cursor.value === null ? resumeRefused.value : null);
  const nose = noseWords(shown);
  return (
    <div class="words">
      <div
        class={`state-words ${lost ? "stale" : `tone-${toneOfPhase(shown.phase)}`}`}
        data-testid="state-words"
        data-phase={shown.phase}
        role="status"
      >
        <span data-testid="phase" hidden>
          {shown.phase}
        </span>
        {lost ? t("state.lost", { age: formatAge(silence) }) : words}
      </div>
      <Elsewhere />
      <div class="state-more">
        <span data-testid="control">{controlWords()}</span>
        {waits && <span data-testid="waits-for">{t("state.waitsFor", { what: waits })}</span>}
        {nose && <span data-testid="nose">{nose}</span>}
        {startedMs !== null && (
          <span data-testid="mission-time" title={shown.spec?.name}>
            {t("state.time", { duration: formatDuration((shownTimeMs.value - startedMs) / 1000) })}
          </span>
        )}
        {shown.spec && <span class="mission-name">{shown.spec.name}</span>}
      </div>
    </div>
  );
}

/** What the vehicle makes of the order that was given last: done only when its telemetry says so. */
function OrderNote() {
  const { status } = live.value;
  const order = status?.value.crafts.find(({ craft_id }) => craft_id === flying.value?.craftId)?.order;
  if (!order) return null;
  const command = t(`bar.${order.order}` satisfies MessageKey);
  const way = t(`bar.${order.way}` satisfies MessageKey);
  const reason = order.because ? reasonText(order.because) : "";
  const isNews = status!.atMs > Number(urgent.value[order.order]?.newsMs); // "done" may be of an earlier one
  if (order.stage === "done" && order.because === null) return isNews ? <span>{t("bar.order.done", { command })}</span> : null;
  const key = order.stage === "done" ? "bar.order.instead" : reason ? "bar.order.refused" : "bar.order.tried";
  return (
    <span class={reason ? "not-done" : ""} data-testid="order-note" data-stage={order.stage} role={reason ? "alert" : "status"}>
      {t(key, { command, way, reason })}
    </span>
  );
}

function UrgentNote() {
  const sent = Object.entries(urgent.value) as [Urgent, NonNullable<(typeof urgent.value)[Urgent]>][];
  const under = sent.filter(([, state]) => state.stage !== "accepted");
  if (sent.length === 0 && !flying.value) return null;
  return (
    <div class="urgent-note" role="status" data-testid="urgent-note">
      {under.map(([kind, state]) => {
        const command = t(`bar.${kind}` satisfies MessageKey);
        const key = state.stage === "sending" ? "bar.sending" : "bar.retrying";
        return <span key={kind}>{t(key, { command, count: state.count })}</span>;
      })}
      <OrderNote />
    </div>
  );
}

/** A low battery in hold: somebody may stop the return, once. Only of the flight as it is now. */
function Countdown() {
  const { returnsAt, missionId } = mission.value;
  const id = flying.value?.id;
  if (returnsAt === null || cursor.value !== null || !id || id !== missionId) return null;
  const seconds = Math.max(0, Math.ceil((Date.parse(returnsAt) - serverNowMs.value) / 1000));
  return (
    <div class="urgent-note countdown" role="alert" data-testid="countdown">
      <span>{t("bar.countdown", { seconds })}</span>{" "}
      <button type="button" data-testid="keep-holding" onClick={() => void send("bar", id, { kind: "keep_holding" })}>
        {t("bar.keepHolding")}
      </button>
    </div>
  );
}

export function SafetyBar() {
  const notes = useRef<HTMLDivElement>(null);
  const target = flying.value;
  /** What is armed for one vehicle of one mission is not armed for another. */
  const to = target && `${target.id} ${target.craftId}`;
  useEffect(() => {
    const measured = new ResizeObserver(([entry]) => {
      const height = Math.ceil(entry!.borderBoxSize[0]!.blockSize);
      document.documentElement.style.setProperty("--note", `${height === 0 ? 0 : height + 6}px`);
    });
    measured.observe(notes.current!);
    return () => measured.disconnect();
  }, []);
  return (
    <header class="safety" data-tour="1">
      <div class="safety-row">
        {/* biome-ignore lint/a11y/useSemanticElements: a fieldset groups the fields of a form, these are commands */}
        <div class="urgents" role="group" aria-label={t("bar.label")}>
          <UrgentButton kind="abort" />
          <UrgentButton kind="hold" />
          <UrgentButton kind="return" />
          <Landing key={to} />
        </div>
        <Resume key={to} />
        <Words />
        <Indicators />
        <ControlButton />
        <AlertsButton />
        <Menu />
      </div>
      <div class="bar-notes" ref={notes}>
        <ControlAsked />
        <Countdown />
        <UrgentNote />
        <ProblemNote desk="bar" />
      </div>
    </header>
  );
}
