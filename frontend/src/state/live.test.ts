import { describe, expect, it } from "vitest";
import type { SourceMessage } from "../sources/source";
import type { MissionEvent, TelemetryMessage } from "../wire";
import { CRAFT, EMITTER, leadingTo, record, someBearing, someTelemetry, started } from "../wire/examples";
import { emptyLive, type LiveState, reduceLive, turnOf } from "./live";

const telemetry = (lat: number, lon: number, changes: Partial<TelemetryMessage> = {}) => someTelemetry({ lat, lon, ...changes });

const run = (...messages: SourceMessage[]): LiveState =>
  messages.reduce((state, message, i) => reduceLive(state, message, 1000 * i), emptyLive);

const told = (...events: MissionEvent[]): SourceMessage[] => record(...events).map((recorded) => ({ type: "event", recorded }));

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
    expect(run(...told(...leadingTo("flying")), ...flown).paths.get(CRAFT)).toHaveLength(2);
    expect(run(...told(...leadingTo("ready")), ...flown).paths.get(CRAFT)).toBeUndefined();
  });

  it("drops an event it already has", () => {
    const recorded = record(someBearing())[0]!;
    expect(run({ type: "event", recorded }, { type: "event", recorded }).events).toHaveLength(1);
  });

  it("ends the running sweep when its bearing is there", () => {
    const progress: SourceMessage = {
      type: "sweep_progress",
      mission_id: "m",
      craft_id: CRAFT,
      emitter_id: EMITTER,
      place_number: 1,
      heading_deg: [1],
      power_db: [-60],
      turned_deg: 3,
      sector: null,
    };
    expect(run(progress).sweeps.get(CRAFT)?.get(EMITTER)?.value.turned_deg).toBe(3);
    expect(run(progress, ...told(someBearing())).sweeps.has(CRAFT)).toBe(false);
    const foreign = someBearing({ source: { kind: "person", name: "Ada" } });
    expect(
      run(progress, ...told(foreign))
        .sweeps.get(CRAFT)
        ?.get(EMITTER)?.value.turned_deg,
    ).toBe(3);
  });

  it("tells of a turn what was heard of the emitter asked for, and how far the craft has turned", () => {
    const progress = (emitter_id: string, power_db: number[], turned_deg: number): SourceMessage => ({
      type: "sweep_progress",
      mission_id: "m",
      craft_id: CRAFT,
      emitter_id,
      place_number: 1,
      heading_deg: power_db.map((_, i) => i),
      power_db,
      turned_deg,
      sector: null,
    });
    const turn = run(progress("a", [-60], 10), progress("b", [-70, -71], 20)).sweeps.get(CRAFT);
    expect(turnOf(turn, "a")).toMatchObject({ emitter_id: "a", power_db: [-60], turned_deg: 20 });
    expect(turnOf(turn, "b")).toMatchObject({ power_db: [-70, -71], turned_deg: 20 });
    expect(turnOf(turn, "silent")).toMatchObject({ emitter_id: "silent", power_db: [], turned_deg: 20 });
    expect(turnOf(undefined, "a")).toBeNull();
  });

  it("keeps two craft apart: what they tell and where they flew", () => {
    const other = "craft-2";
    const state = run(
      ...told(started(), started({ craft_id: other })),
      telemetry(50, 7, { battery_percent: 80 }),
      telemetry(51, 8, { battery_percent: 40, craft_id: other }),
    );
    expect([CRAFT, other].map((id) => state.telemetry.get(id)?.value.battery_percent)).toEqual([80, 40]);
    expect([CRAFT, other].map((id) => state.paths.get(id))).toEqual([[[7, 50]], [[8, 51]]]);
  });

  it("a changed link is not a sign of life", () => {
    const state = run(
      { type: "hello", server_version: "", mission_id: null, last_seq: 0, time_factor: 1 },
      { type: "link", state: "closed", attempt: 0 },
    );
    expect(state.lastMessageMs).toBe(0);
    expect(state.link).toEqual({ state: "closed", attempt: 0, sinceMs: 1000 });
  });

  it("counts what could not be read", () => {
    expect(run({ type: "unreadable", detail: "x" }, { type: "unreadable", detail: "y" }).unreadable).toBe(2);
  });
});
