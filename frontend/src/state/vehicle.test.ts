// @vitest-environment happy-dom
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { FakeSource } from "../sources/fakeSource";
import { localProblem, RequestFailed } from "../sources/problem";
import type { Hello, TrackFact } from "../wire";
import { CRAFT, record, someTelemetry, started } from "../wire/examples";
import { open } from "./open";
import { path } from "./vehicle";

const hello = { type: "hello", last_seq: 1, mission_id: "m", server_version: "", time_factor: 1 } as Hello;

beforeEach(() => vi.useFakeTimers());
afterEach(() => vi.useRealTimers());

it("reads what was flown again after a gap, and once only before", async () => {
  const stored: TrackFact[] = [];
  const source = new FakeSource();
  const track = vi.spyOn(source, "track").mockImplementation(async () => ({ mission_id: "m", craft_id: CRAFT, points: [...stored] }));
  open(source);
  source.tell(hello, { type: "event", recorded: record(started())[0]! }, someTelemetry({ craft_id: CRAFT, lon: 7.1 }));
  await vi.advanceTimersByTimeAsync(1000);
  expect(track).toHaveBeenCalledOnce();
  for (const lon of [7.1, 7.15, 7.2]) stored.push({ at_utc: "2026-05-01T10:00:00Z", lat: 50.7, lon, heading_deg: 0 } as TrackFact);
  source.tell({ ...hello }, someTelemetry({ craft_id: CRAFT, lon: 7.2 }));
  await vi.advanceTimersByTimeAsync(1000);
  expect(path.value.map(([lon]) => lon)).toEqual([7.1, 7.15, 7.2]);
});

it("keeps what was heard while the track was under way, and asks again for one that was lost", async () => {
  const source = new FakeSource();
  const stored = { at_utc: "2026-05-01T10:00:00Z", lat: 50.7, lon: 7.1, heading_deg: 0 } as TrackFact;
  const track = vi.spyOn(source, "track").mockRejectedValueOnce(new Error("no link"));
  open(source);
  source.tell(hello, { type: "event", recorded: record(started())[0]! }, someTelemetry({ craft_id: CRAFT, lat: 50.7, lon: 7.1 }));
  await vi.advanceTimersByTimeAsync(1000);
  expect(track).toHaveBeenCalledOnce();
  let answer: (value: Awaited<ReturnType<typeof source.track>>) => void = () => undefined;
  track.mockReturnValue(new Promise((resolve) => (answer = resolve)));
  await vi.advanceTimersByTimeAsync(6000);
  expect(track).toHaveBeenCalledTimes(2);
  source.tell(someTelemetry({ craft_id: CRAFT, lat: 50.7, lon: 7.2 }));
  await vi.advanceTimersByTimeAsync(1000);
  answer({ mission_id: "m", craft_id: CRAFT, points: [stored] });
  await vi.advanceTimersByTimeAsync(100);
  expect(path.value.map(([lon]) => lon)).toEqual([7.1, 7.2]);
});

it("asks for a lost track once at a time, not for one that was refused or left", async () => {
  const source = new FakeSource();
  const track = vi.spyOn(source, "track").mockRejectedValue(new Error("no link"));
  open(source);
  source.tell(hello, { type: "event", recorded: record(started())[0]! }, someTelemetry({ craft_id: CRAFT }));
  for (let hellos = 0; hellos < 6; hellos++) {
    source.tell({ ...hello });
    await vi.advanceTimersByTimeAsync(100);
  }
  track.mockClear();
  await vi.advanceTimersByTimeAsync(20_000);
  expect(track.mock.calls.length).toBeLessThanOrEqual(4);
  track.mockClear().mockRejectedValue(new RequestFailed(localProblem("gone", "", 404)));
  await vi.advanceTimersByTimeAsync(60_000);
  expect(track).toHaveBeenCalledOnce();
  track.mockRejectedValue(new Error("no link"));
  source.tell({ ...hello });
  await vi.advanceTimersByTimeAsync(1000);
  const next = new FakeSource("n");
  const nextTrack = vi.spyOn(next, "track");
  open(next);
  next.tell({ ...hello, mission_id: "n" }, { type: "event", recorded: record(started())[0]! }, someTelemetry({ craft_id: CRAFT }));
  await vi.advanceTimersByTimeAsync(20_000);
  expect(nextTrack).toHaveBeenCalledOnce();
});
