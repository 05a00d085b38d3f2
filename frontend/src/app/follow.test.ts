// @vitest-environment happy-dom
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { type ReplaySource, replays } from "../sources/replay";
import { source } from "../state/connection";
import { isGone, noteGone } from "../state/gone";
import { route } from "../state/route";
import { session } from "../state/session";
import { followRoute } from "./follow";

vi.mock("../sources/live", async () => ({ LiveSource: (await import("../sources/fakeSource")).FakeSource }));

let stop: () => void;
beforeEach(() => {
  session.value = "unreachable";
  route.value = { page: "missions" };
  stop = followRoute();
});
afterEach(() => stop());

it("shows a recording again when one comes back to it from another page", () => {
  const recording = Object.assign(new FakeSource(), { missionId: "m" }) as unknown as ReplaySource;
  replays.set("m", recording);
  route.value = { page: "mission", missionId: "m" };
  expect(source.value).toBe(recording);
  route.value = { page: "bearings", missionId: "m" };
  expect(source.value).toBe(recording);
  route.value = { page: "health" };
  expect(source.value).not.toBe(recording);
  route.value = { page: "mission", missionId: "m" };
  expect(source.value).toBe(recording);
  replays.clear();
});

it("asks the server again for a mission that it had not, when it is looked at another time", () => {
  route.value = { page: "mission", missionId: "m" };
  noteGone("m");
  expect(isGone("m")).toBe(true);
  route.value = { page: "missions" };
  expect(isGone("m")).toBe(false);
});
