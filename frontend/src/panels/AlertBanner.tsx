// The most urgent open alert, over the map until somebody acknowledges it.
import { signal } from "@preact/signals";
import { useLayoutEffect, useMemo, useRef } from "preact/hooks";
import { send } from "../commands/send";
import { type MessageKey, reasonRemedy, reasonText, t } from "../i18n";
import { alertRank, sortAlerts } from "../state/alerts";
import { liveMission } from "../state/moment";
import { TAP_MS } from "../state/tap";
import { acknowledgeable, openAlerts } from "./AlertsButton";

/** Pixels that the banner takes from the map's top; 0 without one. The map's tools and its frame keep clear of it. */
export const bannerPx = signal(0);

export function AlertBanner() {
  const first = sortAlerts(openAlerts.value)[0];
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
  const since = useMemo(() => performance.now(), [first?.id]);
  if (!shown) return null;
  const id = liveMission.value.missionId;
  const remedy = reasonRemedy(first.reason);
  const acknowledge = ({ timeStamp }: Event) => {
    if (timeStamp - since < TAP_MS) return; // the tap was for another
    void send("alerts", id!, { kind: "acknowledge_alert", alert_id: first.id });
  };
  return (
    <div class={`banner ${first.level}`} role="alert" data-testid="alert-banner" ref={box}>
      <span>
        <strong>{t(`alerts.${first.level}` satisfies MessageKey)}:</strong> {reasonText(first.reason)}{" "}
        {remedy && t("problem.remedy", { remedy })}
      </span>
      {id && acknowledgeable(first) && (
        <button type="button" onClick={acknowledge}>
          {t("alerts.acknowledge")}
        </button>
      )}
    </div>
  );
}
