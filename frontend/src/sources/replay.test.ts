// @vitest-environment happy-dom
import { describe, expect, it, vi } from "vitest";
import { phase, record, someBearing, someSpec } from "../state/examples";
import { emptyLive, reduceLive, type LiveState } from "../state/live";
import { NotARecording, readRecording } from "./replay";
import * as api from "./api";
import { RequestFailed } from "./problem";
import type { SourceMessage } from "./source";

const recorded = record({ kind: "mission_drafted", spec: someSpec() }, phase("flying"), someBearing());

const silent = { start: () => undefined, stop: () => undefined };
const opened = () => readRecording(JSON.stringify({ events: recorded }), silent);

describe("a recording", () => {
  it("folds to the same mission as the live events did", () => {
    const live = recorded.reduce<LiveState>((s, r) => reduceLive(s, { type: "event", recorded: r }, 0), emptyLive);
    let replayed = emptyLive;
    opened().start((m) => (replayed = reduceLive(replayed, m, 0)));
    expect(replayed.mission).toEqual(live.mission);
    expect(replayed.events).toEqual(live.events);
  });

  it("keeps the bar above it the server's, and leaves the server's missions out", () => {
    const told: SourceMessage[] = [
      { type: "link", state: "closed", attempt: 1 },
      { type: "event", recorded: { ...recorded[0]!, mission_id: "another" } },
      { type: "hello", server_version: "", mission_id: null, last_seq: 0, time_factor: 1 },
    ];
    const heard: SourceMessage[] = [];
    const server = { start: (listener: (m: SourceMessage) => void) => told.forEach(listener), stop: vi.fn() };
    const replay = readRecording(JSON.stringify({ events: recorded }), server);
    replay.start((m) => heard.push(m));
    expect(heard.slice(1 + recorded.length)).toEqual([told[0]]);
    replay.stop();
    expect(server.stop).toHaveBeenCalledOnce();
  });

  it("takes no command itself, but stops what flies", async () => {
    const sent = vi.spyOn(api, "sendCommand").mockResolvedValue({ command_id: "c", accepted: true, reason: "", remedy: "", seq: 1 });
    const { missionId } = opened();
    await expect(opened().send(missionId, { kind: "accept" })).rejects.toBeInstanceOf(RequestFailed);
    expect(sent).not.toHaveBeenCalled();
    await opened().send(missionId, { kind: "abort" }, "c");
    await opened().send("another", { kind: "resume" }, "d");
    expect(sent.mock.calls.map(([id, command]) => [id, command.kind])).toEqual([[missionId, "abort"], ["another", "resume"]]); // prettier-ignore
  });

  it.each([["{", /JSON/], ["{}", /no events/], ['{"events":[{"x":1}]}', /entry 1/]])("says what is wrong with %s", (text, why) => { // prettier-ignore
    expect(() => readRecording(text)).toThrow(NotARecording);
    expect(() => readRecording(text)).toThrow(why);
  });
});
