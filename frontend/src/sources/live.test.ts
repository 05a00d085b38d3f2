// @vitest-environment happy-dom
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { record, someBearing } from "../wire/examples";
import { LiveSource, retryDelayMs } from "./live";
import type { SourceMessage } from "./source";

class FakeSocket {
  static made: FakeSocket[] = [];
  binaryType = "";
  onopen: (() => void) | null = null;
  onclose: ((e: { code: number }) => void) | null = null;
  onmessage: ((e: { data: string }) => void) | null = null;
  constructor(readonly url: string) {
    FakeSocket.made.push(this);
  }
  close = vi.fn();
  tell(message: unknown) {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
}

describe("the live source", () => {
  const heard: SourceMessage[] = [];
  beforeEach(() => {
    vi.useFakeTimers();
    vi.stubGlobal("WebSocket", FakeSocket);
    FakeSocket.made = [];
    heard.length = 0;
  });
  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });
  const start = () => {
    const source = new LiveSource("m", true);
    source.start((m) => heard.push(m));
    return source;
  };

  it("asks for its mission, thin frames, and everything after what it has", async () => {
    start();
    expect(FakeSocket.made[0]!.url).toContain("mission=m");
    expect(FakeSocket.made[0]!.url).toContain("lite=1");
    expect(FakeSocket.made[0]!.url).toContain("after=0");
    for (const recorded of record(someBearing(), someBearing())) FakeSocket.made[0]!.tell({ type: "event", recorded });
    FakeSocket.made[0]!.onclose?.({ code: 1006 });
    await vi.advanceTimersByTimeAsync(10_000);
    expect(FakeSocket.made[1]!.url).toContain("after=2");
  });

  it("passes on each event once, whatever is sent again", () => {
    start();
    const recorded = record(someBearing())[0]!;
    FakeSocket.made[0]!.tell({ type: "event", recorded });
    FakeSocket.made[0]!.tell({ type: "event", recorded });
    expect(heard.filter((m) => m.type === "event")).toHaveLength(1);
  });

  it("takes a silent socket for dead and connects again", async () => {
    start();
    await vi.advanceTimersByTimeAsync(7_000);
    expect(FakeSocket.made[0]!.close).toHaveBeenCalled();
    expect(heard.at(-1)).toMatchObject({ type: "link" });
    await vi.advanceTimersByTimeAsync(2_000);
    expect(FakeSocket.made.length).toBeGreaterThan(1);
  });

  it("asks again for events that were promised and did not come", async () => {
    start();
    const status = { type: "status", phase: null };
    FakeSocket.made[0]!.tell({ type: "hello", last_seq: 2, mission_id: "m", server_version: "", time_factor: 1 });
    for (let second = 0; second < 12; second++) {
      FakeSocket.made[0]!.tell(status);
      await vi.advanceTimersByTimeAsync(1_000);
    }
    expect(FakeSocket.made.length).toBeGreaterThan(1);
  });

  it("is content when the promised events came", async () => {
    start();
    FakeSocket.made[0]!.tell({ type: "hello", last_seq: 1, mission_id: "m", server_version: "", time_factor: 1 });
    FakeSocket.made[0]!.tell({ type: "event", recorded: record(someBearing())[0]! });
    for (let second = 0; second < 12; second++) {
      FakeSocket.made[0]!.tell({ type: "status", phase: null });
      await vi.advanceTimersByTimeAsync(1_000);
    }
    expect(FakeSocket.made).toHaveLength(1);
  });

  it("does not connect again once it was stopped", async () => {
    const source = start();
    source.stop();
    FakeSocket.made[0]!.onclose?.({ code: 1006 });
    await vi.advanceTimersByTimeAsync(30_000);
    expect(FakeSocket.made).toHaveLength(1);
  });

  it("says once that there is no such mission, and asks no more", async () => {
    start();
    FakeSocket.made[0]!.onclose?.({ code: 4404 });
    await vi.advanceTimersByTimeAsync(30_000);
    expect(heard.at(-1)).toEqual({ type: "gone", missionId: "m" });
    expect(FakeSocket.made).toHaveLength(1);
  });

  it("counts a message it cannot read", async () => {
    start();
    FakeSocket.made[0]!.onmessage?.({ data: "{" });
    await vi.advanceTimersByTimeAsync(0);
    expect(heard.at(-1)?.type).toBe("unreadable");
  });
});

it("waits longer with every failure, never longer than eight seconds, never not at all", () => {
  for (let attempt = 0; attempt < 12; attempt++) {
    expect(retryDelayMs(attempt, 0)).toBeGreaterThanOrEqual(250);
    expect(retryDelayMs(attempt, 1)).toBeLessThanOrEqual(8000);
  }
  expect(retryDelayMs(3, 0.5)).toBeGreaterThan(retryDelayMs(1, 0.5));
});
