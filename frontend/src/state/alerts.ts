// Warning before caution before advisory (after 14 CFR 25.1322), the newest first within a level.
import type { AlertLevel } from "../wire";
import type { Alert } from "./mission";

const RANK: Record<AlertLevel, number> = { warning: 0, caution: 1, advisory: 2 };

export const alertRank = (level: AlertLevel): number => RANK[level];

export const isOpen = (alert: Alert): boolean => !alert.cleared && alert.acknowledgedBy === null;

export function sortAlerts(alerts: readonly Alert[]): Alert[] {
  return alerts.toSorted(
    (a, b) => Number(isOpen(b)) - Number(isOpen(a)) || RANK[a.level] - RANK[b.level] || b.raisedAt.localeCompare(a.raisedAt),
  );
}
