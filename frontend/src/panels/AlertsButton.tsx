// Warning, caution, advisory: how many are open, the list, acknowledgement, mute.
import { computed, signal } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";
import { send } from "../commands/send";
import { type MessageKey, personName, reasonRemedy, reasonText, t } from "../i18n";
import { alertRank, isOpen, sortAlerts } from "../state/alerts";
import { shownCraftAlerts } from "../state/craftAlerts";
import type { Alert } from "../state/mission";
import { cursor, liveMission } from "../state/moment";
import { overlay, toggle } from "../state/overlay";
import { change, settings } from "../state/settings";
import { mission, shownTimeMs } from "../state/shown";
import { formatAge } from "../units/quantities";
import { ProblemNote } from "./ProblemNote";

const all = computed(() => [...mission.value.alerts, ...shownCraftAlerts.value]);
const open = computed(() => all.value.filter(isOpen));
/** Of the mission while it lasts: what a craft without one says nobody acknowledges, it goes by itself. */
const acknowledgeable = ({ id }: Alert) =>
  cursor.value === null && !mission.value.ended && mission.value.alerts.some((alert) => alert.id === id);
const worst = computed(() => sortAlerts(open.value)[0]?.level ?? null);

function AlertRow({ alert }: { alert: Alert }) {
  const age = Math.max(0, (shownTimeMs.value - Date.parse(alert.raisedAt)) / 1000);
  const id = liveMission.value.missionId;
  const remedy = reasonRemedy(alert.reason);
  return (
    <li class={`alert-row ${isOpen(alert) ? alert.level : "past"}`} data-testid="alert-row" data-level={alert.level}>
      <div>
        <strong>{t(`alerts.${alert.level}` satisfies MessageKey)}</strong> <span class="muted">{formatAge(age)}</span>
        <div>{reasonText(alert.reason)}</div>
        {remedy && <div class="problem-remedy">{t("problem.remedy", { remedy })}</div>}
        {alert.acknowledgedBy && <div class="muted">{t("alerts.acknowledged", { by: personName(alert.acknowledgedBy) })}</div>}
        {alert.cleared && <div class="muted">{t("alerts.cleared")}</div>}
      </div>
      {isOpen(alert) && id && acknowledgeable(alert) && (
        <button
          type="button"
          data-testid="acknowledge"
          onClick={() => void send("alerts", id, { kind: "acknowledge_alert", alert_id: alert.id })}
        >
          {t("alerts.acknowledge")}
        </button>
      )}
    </li>
  );
}

function AlertsSheet() {
  const alerts = sortAlerts(all.value);
  return (
    <div class="popover" role="dialog" aria-label={t("alerts.title")} data-testid="alerts-panel">
      <div class="popover-head">
        <h2>{t("alerts.title")}</h2>
        <button
          type="button"
          data-testid="mute"
          aria-pressed={!settings.value.tones}
          onClick={() => change("tones", !settings.value.tones)}
        >
          {t(settings.value.tones ? "alerts.mute" : "alerts.unmute")}
        </button>
      </div>
      <ProblemNote desk="alerts" />
      {alerts.length === 0 ? (
        <p class="muted">{t("alerts.none")}</p>
      ) : (
        <ul class="alert-list">
          {alerts.map((alert) => (
            <AlertRow alert={alert} key={alert.id} />
          ))}
        </ul>
      )}
    </div>
  );
}

export function AlertsButton() {
  const count = open.value.length;
  return (
    <div class="anchor">
      <button
        type="button"
        class={`alerts ${worst.value ?? ""}`}
        data-testid="alerts"
        data-count={count}
        aria-expanded={overlay.value === "alerts"}
        title={t("bar.alerts.count", { count })}
        onClick={() => toggle("alerts")}
      >
        <span>{t("bar.alerts")}</span>
        <b>{count}</b>
        {!settings.value.tones && <small>{t("alerts.muted")}</small>}
      </button>
      {overlay.value === "alerts" && <AlertsSheet />}
    </div>
  );
}

/** Pixels that the banner takes from the map's top; 0 without one. The map's tools and its frame keep clear of it. */
export const bannerPx = signal(0);

/** The most urgent open alert, over the map until somebody acknowledges it. */
export function AlertBanner() {
  const first = sortAlerts(open.value)[0];
  const shown = first !== undefined && alertRank(first.level) <= alertRank("caution");
  const box = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    if (!box.current) return;
    const measured = new ResizeObserver(([entry]) => {
      bannerPx.value = Math.ceil(entry!.borderBoxSize[0]!.blockSize);
    });
    measured.observe(box.current);
    return () => {
      measured.disconnect();
      bannerPx.value = 0;
    };
  }, [shown]);
  if (!shown) return null;
  const id = liveMission.value.missionId;
  const remedy = reasonRemedy(first.reason);
  return (
    <div class={`banner ${first.level}`} role="alert" data-testid="alert-banner" ref={box}>
      <span>
        <strong>{t(`alerts.${first.level}` satisfies MessageKey)}:</strong> {reasonText(first.reason)}{" "}
        {remedy && t("problem.remedy", { remedy })}
      </span>
      {id && acknowledgeable(first) && (
        <button type="button" onClick={() => void send("alerts", id, { kind: "acknowledge_alert", alert_id: first.id })}>
          {t("alerts.acknowledge")}
        </button>
      )}
    </div>
  );
}
