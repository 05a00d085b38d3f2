// Alerts of crafts that fly for no mission: no journal tells of them, the status does.
import { computed } from "@preact/signals";
import type { StatusMessage } from "../wire";
import { live } from "./connection";
import type { Alert } from "./mission";
import { cursor } from "./moment";

/** Beside a mission's own: none of them is acknowledged, each goes when it is over. */
export function alertsOf(status: StatusMessage | null): Alert[] {
  return (status?.crafts ?? []).flatMap((craft) =>
    craft.alerts.map((alert) => ({
      id: `no-mission-${alert.alert_id}-${alert.raised_at_s}`,
      topic: alert.topic,
      level: alert.level,
      reason: alert.reason,
      craftId: craft.craft_id,
      emitterId: null,
      raisedAt: new Date(alert.raised_at_s * 1000).toISOString(),
      acknowledgedBy: null,
      cleared: false,
    })),
  );
}

export const craftAlerts = computed<Alert[]>(() => alertsOf(live.value.status?.value ?? null));

/** While a past moment is looked at, the present ones do not belong there. */
export const shownCraftAlerts = computed<Alert[]>(() => (cursor.value === null ? craftAlerts.value : []));
