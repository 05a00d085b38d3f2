import { expect, it } from "vitest";
import { CRAFT, someCraftStatus, someReason, someStatus } from "../wire/examples";
import { atPresent, isOpen, sortAlerts } from "./alerts";
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

it("a loss of samples is shown as it is now, of the craft that it is about, while the alert lasts", () => {
  const loses = (changes: Partial<Alert> = {}) =>
    alert("a", "caution", "", { craftId: CRAFT, reason: { code: "samples_lost", lost_percent: 8 }, ...changes });
  const heard = (receiver: "ok" | "lost", percent: number) =>
    someStatus({ crafts: [someCraftStatus({ craft_id: CRAFT, receiver, receiver_lost_percent: percent })] });
  const told = (one: Alert, status: Parameters<typeof atPresent>[1]) => atPresent([one], status)[0]!.reason;
  expect(told(loses(), heard("ok", 30.4))).toMatchObject({ code: "samples_lost", lost_percent: 31 });
  for (const [one, status] of [
    [loses(), null],
    [loses(), heard("lost", 0)],
    [loses({ craftId: "another" }), heard("ok", 31)],
    [loses({ cleared: true }), heard("ok", 31)],
    [alert("b", "caution", "", { craftId: CRAFT }), heard("ok", 31)],
  ] as const)
    expect(told(one, status)).toBe(one.reason);
});
