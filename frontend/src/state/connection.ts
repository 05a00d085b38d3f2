// What the page hears: the source that speaks, and everything it has told, folded.
import { batch, computed, signal } from "@preact/signals";
import type { Source, SourceMessage } from "../sources/source";
import { moveClock, nowMs } from "./clock";
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
let scheduled = false;
let waiting: ReturnType<typeof setTimeout> | undefined;

/** These are shown with the next telemetry, if that comes within the time: each frame drawn costs the whole page. */
const CAN_WAIT: ReadonlySet<SourceMessage["type"]> = new Set(["sweep_progress", "status"]);
const WAIT_MS = 100;

/** What a bearing told is drawn in the very next frame; its picture came right before. */
const isAwaited = (message: SourceMessage) => message.type === "event" && message.recorded.event.kind === "belief_updated";

function flush(): void {
  scheduled = false;
  clearTimeout(waiting);
  waiting = undefined;
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
  pending.push(message);
  if (isAwaited(message)) {
    flush();
    return;
  }
  if (scheduled) return;
  if (CAN_WAIT.has(message.type)) {
    waiting ??= setTimeout(flush, WAIT_MS);
    return;
  }
  scheduled = true;
  if (document.hidden) setTimeout(flush, 50);
  else requestAnimationFrame(flush);
}

/** Another source from now on. What is known of the vehicles stays, so that the safety bar never goes blank. */
export function connect(next: Source): void {
  source.peek()?.stop();
  pending = [];
  const { telemetry, status } = live.peek();
  batch(() => {
    live.value = { ...emptyLive, telemetry, status, link: { ...emptyLive.link, sinceMs: performance.now() } };
    source.value = next;
  });
  next.start((message) => {
    if (source.peek() === next) receive(message);
  });
}
