// The page's own time, by which everything shown ages.
import { signal } from "@preact/signals";

/** Monotonic page time, ms; moves four times a second: with what is heard, else by itself. */
export const nowMs = signal(performance.now());
const TICK_MS = 250;

/** Called with whatever was just heard: one frame then draws both. */
export function moveClock(afterMs = TICK_MS): void {
  const time = performance.now();
  if (time - nowMs.peek() > afterMs) nowMs.value = time;
}

setInterval(() => moveClock(1.5 * TICK_MS), TICK_MS);
