import { expect, it } from "vitest";
import { rowsOf } from "./Payloads";

const payload = {
  name: "pi",
  connected: true,
  age_s: 0.4,
  software: "crossfix",
  receiver: { code: "payload_listening", channels: 1 } as const,
  receiver_ok: true,
  temperature_c: 54.2,
  clock_offset_s: -0.0123,
  round_trip_s: 0.08,
  clipped_percent: 0,
  waiting: 12,
  lost: 0,
  received: 900,
};

const value = (rows: ReturnType<typeof rowsOf>, label: string) => rows.find((row) => row.label === `payload.${label}`);

it("tells a sound payload without alarm", () => {
  const rows = rowsOf(payload);
  expect(rows.filter((row) => row.bad)).toEqual([]);
  expect(value(rows, "clock")?.value).toMatch(/12 ms/);
  expect(value(rows, "radio")?.value).toBe("The payload listens to 1 emitter.");
  expect(value(rows, "lost")).toBeUndefined();
});

it("marks what is wrong", () => {
  const rows = rowsOf({ ...payload, connected: false, receiver_ok: false, clipped_percent: 9, lost: 3, clock_offset_s: null });
  expect(rows.filter((row) => row.bad).map((row) => row.label)).toEqual([
    "payload.link",
    "payload.radio",
    "payload.clipping",
    "payload.lost",
  ]);
});
