// @vitest-environment happy-dom
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import type { ReplaySource } from "../sources/replay";
import { replays } from "../sources/replays";
import { live, source } from "../state/connection";
import { isGone, noteGone } from "../state/gone";
import { emptyLive } from "../state/live";
import { route } from "../state/route";
import { session } from "../state/session";
import { someStatus } from "../wire/examples";
import { followRoute } from "./follow";

vi.mock("../sources/live", async () => ({ LiveSource: (await import("../sources/fakeSource")).FakeSource }));

let stop: () => void;
beforeEach(() => {
  session.value = "unreachable";
  route.value = { page: "missions" };
  stop = followRoute();
});
afterEach(() => {
  stop();
  replays.clear();
  live.value = emptyLive;
});

function recordingOf(missionId: string): ReplaySource {
  const recording = Object.assign(new FakeSource(), { missionId, takesCommands: false }) as unknown as ReplaySource;
  replays.set(missionId, recording);
  return recording;
}

const flies = (mission_id: string | null) => {
  live.value = { ...live.value, status: { value: someStatus({ mission_id }), atMs: 0 } };
};

it("shows a recording again when one comes back to it from another page", () => {
  const recording = recordingOf("m");
  flies("other");
  route.value = { page: "mission", missionId: "m" };
  expect(source.value).toBe(recording);
  route.value = { page: "bearings", missionId: "m" };
  expect(source.value).toBe(recording);
  route.value = { page: "health" };
  expect(source.value).not.toBe(recording);
  route.value = { page: "mission", missionId: "m" };
  expect(source.value).toBe(recording);
});

it.each(["after", "before"])("shows a mission as it flies where it took off %s a recording of it was opened", (when) => {
  if (when === "before") flies("m");
  const recording = recordingOf("m");
  route.value = { page: "mission", missionId: "m" };
  if (when === "after") {
    expect(source.value).toBe(recording);
    flies("m");
  }
  expect(source.value).not.toBe(recording);
  expect([source.value?.missionId, source.value?.takesCommands]).toEqual(["m", true]);
  flies(null);
  expect(source.value?.takesCommands).toBe(true);
});

it("asks the server again for a mission that it had not, when it is looked at another time", () => {
  route.value = { page: "mission", missionId: "m" };
  noteGone("m");
  expect(isGone("m")).toBe(true);
  route.value = { page: "missions" };
  expect(isGone("m")).toBe(false);
});
