// @vitest-environment happy-dom
import { describe, expect, it } from "vitest";
import { phase, record, someBearing, someSpec } from "../state/examples";
import { emptyLive, reduceLive, type LiveState } from "../state/live";
import { NotARecording, readRecording } from "./replay";
import { RequestFailed } from "./problem";

const recorded = record({ kind: "mission_drafted", spec: someSpec() }, phase("flying"), someBearing());

describe("a recording", () => {
  it("folds to the same mission as the live events did", () => {
    const live = recorded.reduce<LiveState>((s, r) => reduceLive(s, { type: "event", recorded: r }, 0), emptyLive);
    let replayed = emptyLive;
    readRecording(JSON.stringify({ events: recorded })).start((m) => (replayed = reduceLive(replayed, m, 0)));
    expect(replayed.mission).toEqual(live.mission);
    expect(replayed.events).toEqual(live.events);
  });

  it("flies nothing", async () => {
    await expect(readRecording(JSON.stringify({ events: recorded })).send()).rejects.toBeInstanceOf(RequestFailed);
  });

  it.each([["{", /JSON/], ["{}", /no events/], ['{"events":[{"x":1}]}', /entry 1/]])("says what is wrong with %s", (text, why) => { // prettier-ignore
    expect(() => readRecording(text)).toThrow(NotARecording);
    expect(() => readRecording(text)).toThrow(why);
  });
});
