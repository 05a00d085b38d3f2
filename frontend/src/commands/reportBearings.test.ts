// @vitest-environment happy-dom
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { pending, type Queued, read, type Stage } from "../state/bearingQueue";
import { countAgain, keepSending, queue, report, sendWaiting } from "./reportBearings";

const KEY = "crossfix.bearings";
const BEARING = { by: "Ada", emitter_id: null, place: { lat: 50.6, lon: 7.2 }, bearing_deg: 12, sigma_deg: 12, snr_db: null };
const of = (id: string, stage: Stage = "waiting"): Queued => ({
  missionId: "m",
  report: { ...BEARING, bearing_id: id, taken_at_utc: null },
  stage,
  problem: null,
});
const ids = () => queue.value.map((one) => one.report.bearing_id);

let sent: string[];
beforeEach(() => {
  sent = [];
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
  report("m", BEARING);
  await sendWaiting();
  expect(pending(queue.value)).toBe(2);
});
