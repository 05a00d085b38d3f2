import { expect, it } from "vitest";
import { someReason } from "../wire/examples";
import { isOpen, sortAlerts } from "./alerts";
import type { Alert } from "./mission";

const alert = (id: string, level: Alert["level"], raisedAt: string, changes: Partial<Alert> = {}): Alert => ({
  id,
  level,
  topic: "vehicle",
  reason: someReason,
  craftId: null,
  emitterId: null,
  raisedAt,
  acknowledgedBy: null,
  cleared: false,
  ...changes,
});

it("open before past, warning before caution before advisory, newest first", () => {
  const sorted = sortAlerts([
    alert("old caution", "caution", "2026-01-01T10:00:00Z"),
    alert("advisory", "advisory", "2026-01-01T12:00:00Z"),
    alert("done warning", "warning", "2026-01-01T13:00:00Z", { acknowledgedBy: "o" }),
    alert("new caution", "caution", "2026-01-01T11:00:00Z"),
    alert("warning", "warning", "2026-01-01T09:00:00Z"),
  ]);
  expect(sorted.map((a) => a.id)).toEqual(["warning", "new caution", "old caution", "advisory", "done warning"]);
});

it("an alert is open until it is acknowledged or over", () => {
  expect(isOpen(alert("a", "warning", ""))).toBe(true);
  expect(isOpen(alert("a", "warning", "", { cleared: true }))).toBe(false);
  expect(isOpen(alert("a", "warning", "", { acknowledgedBy: "o" }))).toBe(false);
});
