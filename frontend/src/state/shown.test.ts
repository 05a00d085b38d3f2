import { beforeEach, expect, it, vi } from "vitest";
import type { Source } from "../sources/source";
import type { MissionEvent } from "../wire";
import { ended, phase, record, someBearing, started } from "../wire/examples";
import { live, source } from "./connection";
import { emptyLive, reduceLive } from "./live";
import { cursor } from "./moment";
import { shownTimeMs } from "./shown";

const LABELLED: MissionEvent = { kind: "mission_labelled", name: "n", tags: [], notes: "", by: "a" };

function show(happensNow: boolean, ...events: MissionEvent[]) {
  const told = record(...events);
  live.value = told.reduce((state, recorded) => reduceLive(state, { type: "event", recorded }, 0), emptyLive);
  source.value = { happensNow } as Source;
  return told.map((one) => Date.parse(one.at_utc));
}

beforeEach(() => {
  cursor.value = null;
  vi.useFakeTimers({ now: Date.parse("2030-01-01T00:00:00Z") });
});

it("is now while a mission flies, and its end once it has one", () => {
  show(true, started(), phase("flying"), someBearing());
  expect(shownTimeMs.value).toBe(Date.now());
  const [, , last] = show(true, started(), phase("flying"), ended("aborted"));
  expect(shownTimeMs.value).toBe(last);
});

it("stands at the last that a recording without an end tells of its flight", () => {
  const [, , last] = show(false, started(), phase("flying"), someBearing(), LABELLED);
  expect(shownTimeMs.value).toBe(last);
});

it("is now where a recording tells nothing", () => {
  show(false);
  expect(shownTimeMs.value).toBe(Date.now());
});
