// Warning before caution before advisory (after 14 CFR 25.1322), the newest first within a level.
import type { AlertLevel, StatusMessage } from "../wire";
import type { Alert } from "./mission";

const RANK: Record<AlertLevel, number> = { warning: 0, caution: 1, advisory: 2 };

export const alertRank = (level: AlertLevel): number => RANK[level];

export const isOpen = (alert: Alert): boolean => !alert.cleared && alert.acknowledgedBy === null;

export function sortAlerts(alerts: readonly Alert[]): Alert[] {
  return alerts.toSorted(
    (a, b) => Number(isOpen(b)) - Number(isOpen(a)) || RANK[a.level] - RANK[b.level] || b.raisedAt.localeCompare(a.raisedAt),
  );
}

/**
 * How much a receiver loses changes while the alert lasts, and is shown as it is now, in whole percent: it is read aloud whenever it
 * changes. status: null while another moment is shown.
 */
export const atPresent = (alerts: readonly Alert[], status: StatusMessage | null): Alert[] =>
  alerts.map((alert) => {
    const craft = status?.crafts.find((one) => one.craft_id === alert.craftId && one.receiver === "ok");
    if (!craft || alert.cleared || alert.reason.code !== "samples_lost") return alert;
    return { ...alert, reason: { ...alert.reason, lost_percent: Math.ceil(craft.receiver_lost_percent) } };
  });
