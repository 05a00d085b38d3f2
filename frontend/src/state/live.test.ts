import { describe, expect, it } from "vitest";
import type { SourceMessage } from "../sources/source";
import type { TelemetryMessage } from "../wire";
import { phase, record, someBearing } from "./examples";
import { emptyLive, reduceLive, type LiveState } from "./live";

const telemetry = (lat: number, lon: number, changes: Partial<TelemetryMessage> = {}): TelemetryMessage => ({
  type: "telemetry", at_utc: "2026-01-01T12:00:00Z", connected: true, lat, lon, position_age_s: 0, altitude_amsl_m: 1, altitude_relative_m: 1,
  heading_deg: 0, heading_age_s: 0, ground_speed_m_s: 0, climb_m_s: 0, battery_percent: 50, battery_age_s: 0, gps_fix: "3D", satellites: 9,
  armed: true, in_air: true, mode: "HOLD", mode_age_s: 0, controller: "crossfix", autopilot: "px4", dropped: 0, ...changes,
}); // prettier-ignore

const run = (...messages: SourceMessage[]): LiveState =>
  messages.reduce((state, message, i) => reduceLive(state, message, 1000 * i), emptyLive);

describe("reduceLive", () => {
  it("leaves the mission untouched by telemetry, so that nothing else is drawn again", () => {
    const before = run({ type: "event", recorded: record(someBearing())[0]! });
    const after = reduceLive(before, telemetry(50, 7), 5);
    expect(after.mission).toBe(before.mission);
    expect(after.events).toBe(before.events);
  });

  it("draws the path in steps of five metres, only in the air", () => {
    const step = 1 / 111_320;
    const flown = [telemetry(50, 7), telemetry(50 + 3 * step, 7), telemetry(50 + 6 * step, 7), telemetry(51, 7, { in_air: false })];
    expect(run({ type: "event", recorded: record(phase("flying"))[0]! }, ...flown).path).toHaveLength(2);
    expect(run({ type: "event", recorded: record(phase("ready"))[0]! }, ...flown).path).toEqual([]);
  });

  it("drops an event it already has", () => {
    const recorded = record(someBearing())[0]!;
    expect(run({ type: "event", recorded }, { type: "event", recorded }).events).toHaveLength(1);
  });

  it("ends the running sweep when its bearing is there", () => {
    const progress: SourceMessage = { type: "sweep_progress", mission_id: "m", place_number: 1, heading_deg: [1], power_db: [-60], turned_deg: 3 };
    expect(run(progress).sweep?.value.turned_deg).toBe(3);
    expect(run(progress, { type: "event", recorded: record(someBearing())[0]! }).sweep).toBeNull();
  });

  it("a changed link is not a sign of life", () => {
    const state = run({ type: "hello", server_version: "", mission_id: null, last_seq: 0, time_factor: 1 }, { type: "link", state: "closed", attempt: 0 });
    expect(state.lastMessageMs).toBe(0);
    expect(state.link).toEqual({ state: "closed", attempt: 0, sinceMs: 1000 });
  });

  it("counts what could not be read", () => {
    expect(run({ type: "unreadable", detail: "x" }, { type: "unreadable", detail: "y" }).unreadable).toBe(2);
  });
});
