// @vitest-environment happy-dom
import { beforeEach, describe, expect, it, vi } from "vitest";
import { emptyLive, type LiveState, reduceLive } from "../state/live";
import type { ExportedMission, TrackFact } from "../wire";
import { CRAFT, phase, record, someBearing, someSpec, started } from "../wire/examples";
import * as api from "./api";
import { localProblem, RequestFailed } from "./problem";
import { readRecording } from "./replay";
import type { SourceMessage } from "./source";

const recorded = record({ kind: "mission_drafted", spec: someSpec() }, started(), phase("flying"), someBearing());
const point: TrackFact = {
  at_utc: "2026-01-01T12:00:00Z",
  lat: 50.7,
  lon: 7.1,
  altitude_amsl_m: 140,
  altitude_relative_m: null,
  heading_deg: 90,
  battery_percent: null,
  mode: null,
};
const exported: ExportedMission = { mission_id: "m", events: recorded, tracks: [{ mission_id: "m", craft_id: CRAFT, points: [point] }] };

const silent = { start: () => undefined, stop: () => undefined };
const opened = () => readRecording("the file", silent);

const read = vi.spyOn(api, "readExported");
beforeEach(() => {
  read.mockReset().mockResolvedValue(exported);
});

describe("a recording", () => {
  it("folds to the same mission as the live events did", async () => {
    const live = recorded.reduce<LiveState>((s, r) => reduceLive(s, { type: "event", recorded: r }, 0), emptyLive);
    let replayed = emptyLive;
    (await opened()).start((m) => (replayed = reduceLive(replayed, m, 0)));
    expect(replayed.mission).toEqual(live.mission);
    expect(replayed.events).toEqual(live.events);
  });

  it("keeps the bar above it the server's, and leaves the server's missions out", async () => {
    const told: SourceMessage[] = [
      { type: "link", state: "closed", attempt: 1 },
      { type: "event", recorded: { ...recorded[0]!, mission_id: "another" } },
      { type: "hello", server_version: "", mission_id: null, last_seq: 0, time_factor: 1 },
    ];
    const heard: SourceMessage[] = [];
    const server = { start: (listener: (m: SourceMessage) => void) => told.forEach(listener), stop: vi.fn() };
    const replay = await readRecording("the file", server);
    replay.start((m) => heard.push(m));
    expect(heard.slice(1 + recorded.length)).toEqual([told[0]]);
    replay.stop();
    expect(server.stop).toHaveBeenCalledOnce();
  });

  it("shows the path of each craft", async () => {
    const replay = await opened();
    expect((await replay.track("m", CRAFT)).points).toEqual([point]);
    expect((await replay.track("m", "another")).points).toEqual([]);
  });

  it("takes no command itself, but stops what flies", async () => {
    const sent = vi.spyOn(api, "sendCommand").mockResolvedValue({ command_id: "c", accepted: true, reason: null, seq: 1 });
    const replay = await opened();
    const { missionId } = replay;
    await expect(replay.send(missionId, { kind: "accept" })).rejects.toBeInstanceOf(RequestFailed);
    expect(sent).not.toHaveBeenCalled();
    await replay.send(missionId, { kind: "abort" }, { commandId: "c" });
    await replay.send("another", { kind: "resume" }, { commandId: "d" });
    expect(sent.mock.calls.map(([id, command]) => [id, command.kind])).toEqual([
      [missionId, "abort"],
      ["another", "resume"],
    ]);
  });

  it("is read by the server, which says what is wrong with a file that is none", async () => {
    await opened();
    expect(read).toHaveBeenCalledWith("the file");
    const refused = new RequestFailed({ ...localProblem("", "", 422), reason: { code: "export_unreadable", fault: "not_json" } });
    read.mockRejectedValue(refused);
    await expect(opened()).rejects.toBe(refused);
  });
});
