// @vitest-environment happy-dom
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { emptyLive, type LiveState, reduceLive } from "../state/live";
import { viewOf } from "../state/view";
import { CRAFT, EMITTER, flown, phase, record, said, servedStatus, someTelemetry } from "../wire/examples";
import * as api from "./api";
import { EXAMPLE_ID, ExampleSource } from "./example";
import { RequestFailed } from "./problem";
import type { SourceMessage } from "./source";

const LONG_MS = 1000 * (said.at(-1)![0] + 1);

let tellFromServer: (message: SourceMessage) => void;
const server = {
  start(listener: (message: SourceMessage) => void) {
    tellFromServer = listener;
  },
  stop: vi.fn(),
};

async function played(source: ExampleSource, ms: number): Promise<SourceMessage[]> {
  const heard: SourceMessage[] = [];
  source.start((message) => heard.push(message));
  await vi.advanceTimersByTimeAsync(ms);
  return heard;
}

const fold = (heard: SourceMessage[]) => heard.reduce<LiveState>((state, m) => reduceLive(state, m, 0), emptyLive);

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe("the recorded example", () => {
  it("flies to its end in real time: bearings, beliefs and all", async () => {
    const source = new ExampleSource(async () => said, server);
    const early = fold(await played(source, 1_000));
    expect([early.mission.missionId, early.mission.ended]).toEqual([EXAMPLE_ID, null]);
    source.stop();
    const late = fold(await played(new ExampleSource(async () => said, server), LONG_MS));
    const seen = viewOf(late.mission);
    expect(seen.phase).toBe("done");
    expect(seen.ended?.fact.outcome).toBe("localized");
    expect(seen.bearings.length).toBeGreaterThanOrEqual(2);
    expect(late.unreadable).toBe(0);
  });

  it("has the belief of each of its moments, the prior before the first", async () => {
    const source = new ExampleSource(async () => said, server);
    await played(source, LONG_MS);
    for (const { seq, event } of flown) {
      if (event.kind === "belief_updated") expect((await source.belief(EXAMPLE_ID, EMITTER, seq))?.bearings).toBe(event.bearings);
    }
    expect(await source.belief(EXAMPLE_ID, EMITTER, 1)).toMatchObject({ missionId: EXAMPLE_ID, emitterId: EMITTER, bearings: 0 });
    expect(await source.belief(EXAMPLE_ID, "another", 1)).toBeNull();
  });

  it("keeps the path that the vehicle flew so far", async () => {
    const source = new ExampleSource(async () => said, server);
    await played(source, 0);
    const { points: before } = await source.track(EXAMPLE_ID, CRAFT);
    await vi.advanceTimersByTimeAsync(LONG_MS);
    const { points } = await source.track(EXAMPLE_ID, CRAFT);
    expect(before.length).toBeLessThan(2);
    expect(points.length).toBeGreaterThan(20);
  });

  it("goes on saying where the vehicle stands when the recording ends, until it is stopped", async () => {
    const source = new ExampleSource(async () => said, server);
    const heard = await played(source, LONG_MS);
    const count = heard.length;
    await vi.advanceTimersByTimeAsync(5_000);
    expect(heard.slice(count).map((m) => m.type)).toEqual(Array(5).fill("telemetry"));
    source.stop();
    await vi.advanceTimersByTimeAsync(5_000);
    expect(heard).toHaveLength(count + 5);
    expect(server.stop).toHaveBeenCalled();
  });

  it("takes no command itself, but what really flies is seen and stopped from here", async () => {
    const sent = vi.spyOn(api, "sendCommand").mockResolvedValue({ command_id: "c", accepted: true, reason: null, seq: 1 });
    const source = new ExampleSource(async () => said, server);
    const heard = await played(source, 1_000);
    await expect(source.send(EXAMPLE_ID, { kind: "abort" })).rejects.toBeInstanceOf(RequestFailed);
    tellFromServer(someTelemetry({ battery_percent: 1 }));
    tellFromServer({ type: "event", recorded: record(phase("hold"))[0]! });
    expect(fold(heard).telemetry.get(CRAFT)?.value.battery_percent).not.toBe(1);
    tellFromServer(servedStatus("real", "returning"));
    tellFromServer(someTelemetry({ battery_percent: 2 }));
    await vi.advanceTimersByTimeAsync(LONG_MS);
    const { status, telemetry, mission } = fold(heard);
    expect([status?.value.mission_id, telemetry.get(CRAFT)?.value.battery_percent, viewOf(mission).phase]).toEqual(["real", 2, "done"]);
    const ownTimes = said.flatMap(([, m]) => (typeof m === "object" && m.type === "telemetry" ? [m.at_utc] : []));
    tellFromServer(someTelemetry({ at_utc: "2031-01-01T00:00:00Z" }));
    expect(fold(heard).telemetry.get(CRAFT)?.value.at_utc, "by its own clock").toBe(ownTimes.at(-1));
    await source.send("real", { kind: "abort" }, { commandId: "c" });
    expect(sent.mock.calls).toEqual([["real", { kind: "abort" }, { commandId: "c" }]]);
  });
});
