// Warning, caution, advisory: how many are open, the list, acknowledgement, mute.
import { computed } from "@preact/signals";
import { send } from "../commands/send";
import { type MessageKey, personName, reasonRemedy, reasonText, t } from "../i18n";
import { atPresent, isOpen, sortAlerts } from "../state/alerts";
import { live, source } from "../state/connection";
import { shownCraftAlerts } from "../state/craftAlerts";
import type { Alert } from "../state/mission";
import { cursor, liveMission } from "../state/moment";
import { overlay, toggle } from "../state/overlay";
import { change, settings } from "../state/settings";
import { mission, shownTimeMs } from "../state/shown";
import { formatAge } from "../units/quantities";
import { ProblemNote } from "./ProblemNote";

const statusShown = computed(() => (cursor.value === null && source.value?.happensNow ? live.value.status : null));
const all = computed(() => atPresent([...mission.value.alerts, ...shownCraftAlerts.value], statusShown.value?.value ?? null));
export const openAlerts = computed(() => all.value.filter(isOpen));
/** Of the mission while it lasts: what a craft without one says nobody acknowledges, it goes by itself. */
export const acknowledgeable = ({ id }: Alert) =>
  cursor.value === null && !mission.value.ended && mission.value.alerts.some((alert) => alert.id === id);
const worst = computed(() => sortAlerts(openAlerts.value)[0]?.level ?? null);

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
  const count = openAlerts.value.length;
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
