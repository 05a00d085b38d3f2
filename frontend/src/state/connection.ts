// What the page hears: the source that speaks, and everything it has told, folded.
import { batch, computed, signal } from "@preact/signals";
import type { Source, SourceMessage } from "../sources/source";
import { moveClock, nowMs } from "./clock";
import { noteGone } from "./gone";
import { emptyLive, type LiveState, reduceLive } from "./live";

export const live = signal<LiveState>(emptyLive);
export const source = signal<Source | null>(null);

/** The server's clock now, ms UTC: a simulated mission's clock runs faster than this page's. */
export const serverNowMs = computed<number>(() => {
  const { telemetry, status, hello } = live.value;
  const newest = [...telemetry.values(), ...(status ? [status] : [])].toSorted((a, b) => b.atMs - a.atMs)[0];
  if (!newest) return Date.now() + 0 * nowMs.value;
  return Date.parse(newest.value.at_utc) + (nowMs.value - newest.atMs) * (hello?.time_factor ?? 1);
});

/** Messages are folded at most once a frame. */
let pending: SourceMessage[] = [];
/** Stops the frame, or the timer of a hidden page, that will fold them; null: none is asked for. */
let unschedule: (() => void) | null = null;
let waiting: ReturnType<typeof setTimeout> | undefined;

/** These are shown with the next telemetry, if that comes within the time: each frame drawn costs the whole page. */
const CAN_WAIT: ReadonlySet<SourceMessage["type"]> = new Set(["sweep_progress", "status"]);
const WAIT_MS = 100;

/** What a bearing told is drawn in the very next frame; its picture came right before. */
const isAwaited = (message: SourceMessage) => message.type === "event" && message.recorded.event.kind === "belief_updated";

/** A bearing is drawn with what it told, if that comes within the time: a frame of its own would be in its way, since
 * without a graphics card one takes longer than the belief. */
const BELIEF_MS = 100;
let bearing: ReturnType<typeof setTimeout> | undefined;

/** What comes between a bearing and its belief, and waits with it; news of any other kind is drawn at once. */
const AMONG: ReadonlySet<SourceMessage["type"]> = new Set(["telemetry", "sweep_progress", "status", "belief"]);
function isAmong(message: SourceMessage): boolean {
  if (message.type !== "event") return AMONG.has(message.type);
  const { event } = message.recorded;
  return event.kind === "bearing_measured" || (event.kind === "phase_changed" && event.after === "planning");
}

function flush(): void {
  unschedule?.();
  unschedule = null;
  clearTimeout(waiting);
  clearTimeout(bearing);
  waiting = bearing = undefined;
  if (pending.length === 0) return;
  const messages = pending;
  pending = [];
  const time = performance.now();
  batch(() => {
    live.value = messages.reduce((state, message) => reduceLive(state, message, time), live.peek());
    moveClock();
  });
}

function receive(message: SourceMessage): void {
  if (message.type === "gone") {
    noteGone(message.missionId);
    return;
  }
  pending.push(message);
  if (isAwaited(message)) {
    flush();
    return;
  }
  if (message.type === "event" && bearing === undefined && pending.every(isAmong)) {
    unschedule?.();
    unschedule = null;
    bearing = setTimeout(flush, BELIEF_MS);
  }
  if (bearing !== undefined && isAmong(message)) return;
  if (unschedule) return;
  if (CAN_WAIT.has(message.type)) {
    waiting ??= setTimeout(flush, WAIT_MS);
    return;
  }
  if (document.hidden) {
    const timer = setTimeout(flush, 50);
    unschedule = () => clearTimeout(timer);
  } else {
    const frame = requestAnimationFrame(flush);
    unschedule = () => cancelAnimationFrame(frame);
  }
}

/** Another source from now on. What is known of the vehicles stays, so that the safety bar never goes blank. */
export function connect(next: Source): void {
  source.peek()?.stop();
  pending = [];
  const { telemetry, status } = live.peek();
  const beganMs = performance.now();
  batch(() => {
    live.value = { ...emptyLive, beganMs, telemetry, status, link: { ...emptyLive.link, sinceMs: beganMs } };
    source.value = next;
  });
  next.start((message) => {
    if (source.peek() === next) receive(message);
  });
}
