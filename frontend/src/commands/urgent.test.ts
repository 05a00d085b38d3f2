// @vitest-environment happy-dom
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { accepted, FakeSource } from "../sources/fakeSource";
import { localProblem, RequestFailed, unreachable } from "../sources/problem";
import type { Flown } from "../state/flying";
import { open } from "../state/open";
import type { Reason } from "../wire";
import { problems } from "./send";
import { resume, sendUrgent, urgent } from "./urgent";

const M: Flown = { id: "m", craftId: "c", phase: "flying" };

let source: FakeSource;
const slowly = () => new Promise<typeof accepted>((resolve) => setTimeout(() => resolve(accepted), 500));
const kinds = () => source.sent.map((s) => s.kind);
let begun = 0;
beforeEach(() => {
  vi.useFakeTimers();
  vi.advanceTimersByTime(60_000 * ++begun); // or a press would be the second tap of the test before
  source = new FakeSource();
  open(source);
});
afterEach(async () => {
  await vi.runAllTimersAsync();
  vi.useRealTimers();
  problems.value = {};
});

it("goes out at once, and says for a while that it was accepted", async () => {
  void sendUrgent(M, "abort");
  expect(source.sent).toMatchObject([{ missionId: "m", kind: "abort" }]);
  expect(urgent.value.abort?.stage).toBe("sending");
  await vi.advanceTimersByTimeAsync(100);
  expect(urgent.value.abort?.stage).toBe("accepted");
  await vi.advanceTimersByTimeAsync(5_000);
  expect(urgent.value).toEqual({});
});

it("goes out again under the same id until the server answers", async () => {
  source.answer = () => (source.sent.length < 3 ? Promise.reject(unreachable("no link")) : Promise.resolve(accepted));
  void sendUrgent(M, "hold");
  await vi.advanceTimersByTimeAsync(1_000);
  expect(urgent.value.hold).toMatchObject({ stage: "retrying", count: 1 });
  expect(problems.value.bar).toBeDefined();
  await vi.advanceTimersByTimeAsync(1_000);
  expect(urgent.value.hold?.stage).toBe("accepted");
  expect(problems.value.bar).toBeUndefined();
  expect(new Set(source.sent.map((s) => s.commandId)).size).toBe(1);
  expect(source.sent).toHaveLength(3);
});

it("is not sent again after a refusal, whose reason stands at the bar", async () => {
  const reason: Reason = { code: "pilot_controls" };
  source.answer = () => Promise.resolve({ ...accepted, accepted: false, reason });
  await sendUrgent(M, "return");
  expect(problems.value.bar?.reason).toEqual(reason);
  await vi.advanceTimersByTimeAsync(1_000);
  source.answer = () => Promise.reject(new RequestFailed(localProblem("no", "no such mission", 404)));
  await sendUrgent(M, "return");
  expect(problems.value.bar?.detail).toBe("no such mission");
  expect(source.sent).toHaveLength(2);
  expect(urgent.value).toEqual({});
});

it("goes out once for a thumb that taps twice, and another command goes out at once", async () => {
  source.answer = slowly;
  void sendUrgent(M, "abort");
  void sendUrgent(M, "abort");
  void sendUrgent(M, "hold");
  expect(kinds()).toEqual(["abort", "hold"]);
  expect(Object.keys(urgent.value)).toEqual(["abort", "hold"]);
});

it("reaches a craft that flies for no mission, which has none to abort", async () => {
  void vi.advanceTimersByTimeAsync(20_000);
  const loose: Flown = { id: null, craftId: "c", phase: "hold" };
  for (const kind of ["abort", "hold", "return", "land"] as const) await sendUrgent(loose, kind);
  expect(source.sent.map((s) => `${s.missionId} ${s.kind}`)).toEqual(["craft c hold", "craft c return", "craft c land"]);
});

it("is not tried again after a newer one, which counts instead", async () => {
  source.answer = () => Promise.reject(unreachable("no link"));
  void sendUrgent(M, "return");
  await vi.advanceTimersByTimeAsync(350);
  void sendUrgent(M, "hold");
  expect(Object.keys(urgent.value)).toEqual(["hold"]);
  source.answer = () => Promise.resolve(accepted);
  await vi.advanceTimersByTimeAsync(3_000);
  expect(kinds()).toEqual(["return", "hold", "hold"]);
});

it("can be given a second time after another kind of order", async () => {
  source.answer = () => Promise.reject(unreachable("no link"));
  for (const kind of ["return", "hold", "return"] as const) void sendUrgent(M, kind);
  await vi.advanceTimersByTimeAsync(800);
  expect(kinds()).toEqual(["return", "hold", "return", "return"]);
  expect(source.sent[0]!.commandId).not.toBe(source.sent[3]!.commandId);
  expect(urgent.value).toMatchObject({ return: { stage: "retrying", count: 1 } });
  source.answer = () => Promise.resolve(accepted);
});

it("goes out once, however late an older one is answered: the server knows which was given last", async () => {
  source.answer = slowly;
  void sendUrgent(M, "return");
  source.answer = () => Promise.resolve(accepted);
  void sendUrgent(M, "hold");
  await vi.advanceTimersByTimeAsync(600);
  expect(kinds()).toEqual(["return", "hold"]);
  const [first, last] = source.sent.map(({ press }) => press!);
  expect(last! > first!).toBe(true);
});

it("is never ended where it aborts, and an abort ends older ones once it is accepted", async () => {
  source.answer = () => Promise.reject(unreachable("no link"));
  void sendUrgent(M, "hold");
  void sendUrgent(M, "abort");
  void sendUrgent(M, "land");
  await vi.advanceTimersByTimeAsync(800);
  expect(Object.keys(urgent.value).toSorted()).toEqual(["abort", "land"]);
  void sendUrgent(M, "hold");
  source.answer = () => Promise.resolve(accepted);
  await vi.advanceTimersByTimeAsync(800);
  expect(Object.keys(urgent.value).toSorted()).toEqual(["abort", "hold"]);
});

it("of one craft is not ended, nor kept back, by one of another", async () => {
  source.answer = () => Promise.reject(unreachable("no link"));
  void sendUrgent(M, "return");
  const other: Flown = { id: "n", craftId: "d", phase: "flying" };
  void sendUrgent(other, "return");
  void sendUrgent(other, "hold");
  source.answer = () => Promise.resolve(accepted);
  await vi.advanceTimersByTimeAsync(800);
  expect(source.sent.map((s) => `${s.missionId} ${s.kind}`)).toEqual(["m return", "n return", "n hold", "m return", "n hold"]);
});

it("goes on when a newer one is refused", async () => {
  source.answer = () => Promise.reject(unreachable("no link"));
  void sendUrgent(M, "hold");
  await vi.advanceTimersByTimeAsync(100);
  source.answer = () => Promise.resolve({ ...accepted, accepted: kinds().at(-1) === "hold", reason: { code: "pilot_controls" } });
  void sendUrgent(M, "return");
  await vi.advanceTimersByTimeAsync(1_000);
  expect(kinds()).toEqual(["hold", "return", "hold"]);
  expect(urgent.value).toMatchObject({ hold: { stage: "accepted", count: 1 } });
  expect(Object.keys(urgent.value)).toEqual(["hold"]);
});

it("stays behind once the search was resumed, however late an answer comes", async () => {
  source.answer = slowly;
  void sendUrgent(M, "return");
  source.answer = () => Promise.resolve(accepted);
  void sendUrgent(M, "hold");
  await vi.advanceTimersByTimeAsync(100);
  void resume(M);
  await vi.advanceTimersByTimeAsync(2_000);
  expect(kinds()).toEqual(["return", "hold", "resume"]);
});

it("does not bring an older one back before a newer one that is still on its way", async () => {
  source.answer = slowly;
  void sendUrgent(M, "return");
  source.answer = () => Promise.resolve(accepted);
  void sendUrgent(M, "hold");
  source.answer = () => Promise.reject(unreachable("no link"));
  void sendUrgent(M, "land");
  await vi.advanceTimersByTimeAsync(600);
  source.answer = () => Promise.resolve(accepted);
  await vi.advanceTimersByTimeAsync(2_000);
  expect(kinds()).toEqual(["return", "hold", "land", "land"]);
});
