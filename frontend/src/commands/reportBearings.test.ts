// @vitest-environment happy-dom
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { pending, type Queued, read, type Stage } from "../state/bearingQueue";
import { session } from "../state/session";
import { backspace, countAgain, keepSending, queue, report, sendWaiting, unreached } from "./reportBearings";

const KEY = "crossfix.bearings";
const BEARING = { by: "Ada", emitter_id: null, place: { lat: 50.6, lon: 7.2 }, bearing_deg: 12, sigma_deg: 12, snr_db: null };
const of = (id: string, stage: Stage = "waiting"): Queued => ({
  missionId: "m",
  report: { ...BEARING, bearing_id: id, taken_at_utc: null },
  stage,
  problem: null,
});
const signedIn = (name: string) =>
  ({ mode: "people", person: { person_id: name, name, role: "operator" } }) as unknown as NonNullable<typeof session.value>;
const ids = () => queue.value.map((one) => one.report.bearing_id);

let sent: string[];
beforeEach(() => {
  sent = [];
  session.value = null;
  queue.value = [];
  localStorage.clear();
  vi.stubGlobal("fetch", async (_path: string, init: RequestInit) => {
    if (init.body) sent.push((JSON.parse(String(init.body)) as { bearing_id: string }).bearing_id);
    return new Response(JSON.stringify({ already: false }), { status: 201, headers: { "content-type": "application/json" } });
  });
});
afterEach(() => {
  vi.restoreAllMocks();
  vi.unstubAllGlobals();
});

it("keeps what another tab of the page put beside it meanwhile", async () => {
  localStorage.setItem(KEY, JSON.stringify([of("of-the-other-tab")]));
  report("m", BEARING);
  expect(read(localStorage.getItem(KEY))).toHaveLength(2);
  await vi.waitFor(() => expect(pending(queue.value)).toBe(0));
  expect(sent).toEqual(ids());
  expect(sent[0]).toBe("of-the-other-tab");
});

it("does not take back what another tab was told", async () => {
  queue.value = [of("a"), of("b")];
  localStorage.setItem(KEY, JSON.stringify([of("a", "sent"), of("b", "back")]));
  countAgain("b");
  await vi.waitFor(() => expect(pending(queue.value)).toBe(0));
  expect(queue.value.map((one) => one.stage)).toEqual(["sent", "sent"]);
  expect(sent.filter((id) => id === "a")).toEqual([]);
});

it("shows what another tab does, while it is open", () => {
  const close = keepSending();
  const text = JSON.stringify([of("x", "sent")]);
  dispatchEvent(new StorageEvent("storage", { key: KEY, newValue: text }));
  close();
  expect(ids()).toEqual(["x"]);
});

it("goes on with what it has where the browser keeps nothing more", async () => {
  localStorage.setItem(KEY, JSON.stringify([of("a", "sent")]));
  vi.spyOn(Storage.prototype, "setItem").mockImplementation(() => {
    throw new DOMException("full", "QuotaExceededError");
  });
  vi.stubGlobal("fetch", () => Promise.reject(new TypeError("no link")));
  report("m", BEARING);
  report("m", { ...BEARING, bearing_deg: 90 });
  await sendWaiting();
  expect(pending(queue.value)).toBe(2);
});

it("sends nobody's bearings in another's name: they wait until that person is signed in again", async () => {
  session.value = signedIn("Ben");
  vi.stubGlobal("fetch", () => Promise.reject(new TypeError("no link")));
  unreached.value = false;
  report("m", { ...BEARING, by: null });
  await vi.waitFor(() => expect(unreached.value).toBe(true));
  const names: string[] = [];
  vi.stubGlobal("fetch", async () => {
    names.push((session.value as { person: { name: string } }).person.name);
    return new Response("{}", { status: 201, headers: { "content-type": "application/json" } });
  });
  session.value = signedIn("Ada");
  await sendWaiting();
  expect([names, pending(queue.value, "Ada"), pending(queue.value, "Ben")]).toEqual([[], 0, 1]);
  session.value = signedIn("Ben");
  await sendWaiting();
  expect([names, queue.value[0]!.stage]).toEqual([["Ben"], "sent"]);
});

it("asks who is signed in before it sends what an earlier page left", async () => {
  queue.value = [{ ...of("a"), who: "Ben" }];
  const asked: string[] = [];
  vi.stubGlobal("fetch", async (path: string) => {
    asked.push(String(path));
    return new Response(JSON.stringify(signedIn("Ada")), { status: 200, headers: { "content-type": "application/json" } });
  });
  await sendWaiting();
  expect([asked.length, queue.value[0]!.stage]).toEqual([1, "waiting"]);
});

it("counts a bearing once that a thumb sends twice", () => {
  vi.stubGlobal("fetch", () => Promise.reject(new TypeError("no link")));
  vi.useFakeTimers();
  report("m", BEARING);
  report("m", { ...BEARING, place: { lat: 50.60001, lon: 7.2 }, bearing_deg: 12.4 });
  expect(queue.value).toHaveLength(1);
  report("m", { ...BEARING, emitter_id: "b" });
  report("other", BEARING);
  expect(queue.value).toHaveLength(3);
  vi.advanceTimersByTime(3000);
  report("m", BEARING);
  expect(queue.value).toHaveLength(4);
  vi.useRealTimers();
});

const OVER = { status: 409, title: "Conflict", detail: "The search is over." };
const UNKNOWN = { status: 422, title: "Wrong", detail: "No such bearing.", reason: { code: "no_such_bearing" } };

it.each([
  ["counts still, and says why, where the server does not take it back", OVER, true, "sent", OVER.detail],
  ["is refused where it did not arrive in time either", OVER, false, "refused", OVER.detail],
  ["is back where the server never had it", UNKNOWN, true, "back", null],
])("%s", async (_name, no, arrived, stage, problem) => {
  const answer = (body: object, status: number) =>
    new Response(JSON.stringify(body), { status, headers: { "content-type": "application/problem+json" } });
  vi.stubGlobal("fetch", async (_path: string, { method }: RequestInit) =>
    method === "POST" && arrived ? answer({ already: true }, 200) : answer(no, no.status),
  );
  session.value = signedIn("Ben");
  queue.value = [of("a", "withdrawing")];
  await sendWaiting();
  expect(queue.value[0]).toMatchObject({ stage, problem });
});

it("takes back one bearing at a thumb's double tap, and the next one at a tap of its own", () => {
  queue.value = [of("a", "sent"), of("b", "sent"), of("c", "sent")];
  const back = () => queue.value.filter((one) => one.stage !== "sent").map((one) => one.report.bearing_id);
  backspace("m", 10_000);
  backspace("m", 10_130);
  expect(back()).toEqual(["c"]);
  backspace("m", 10_900);
  expect(back()).toEqual(["b", "c"]);
});
