// The moment looked at: now, or an event of the past, and the mission as it stood then.
import { computed, signal } from "@preact/signals";
import type { EventKind, Recorded } from "../wire";
import { live } from "./connection";
import { missionAt } from "./mission";
import { selectedCraft, selectedEmitter } from "./selection";
import { type MissionView, viewOf } from "./view";

/** Sequence number of the event looked at; null: now. */
export const cursor = signal<number | null>(null);

export const events = computed(() => live.value.events);

/**
 * The moment that an event stands for: a bearing that came or went with the belief that followed from it, so that estimate,
 * map and panels are those of that event. seq: its number; all: the events in order.
 */
export function settledSeq(all: readonly Recorded[], seq: number): number {
  const at = all.findIndex((e) => e.seq === seq);
  const chosen = all[at]?.event;
  if (!chosen || !COUNTED_ANOTHER_WAY.has(chosen.kind)) return seq;
  const about = "emitter_id" in chosen ? chosen.emitter_id : null;
  for (const { event, seq: later } of all.slice(at + 1)) {
    if (event.kind === "belief_updated" && (about === null || event.emitter_id === about)) return later;
    if (SETTLES.has(event.kind)) break;
  }
  return seq;
}

const COUNTED_ANOTHER_WAY: ReadonlySet<EventKind> = new Set([
  "bearing_measured",
  "bearing_excluded",
  "bearing_included",
  "source_mute_changed",
]);

/** What begins with the next decision: a belief after it is not this bearing's. */
const SETTLES: ReadonlySet<EventKind> = new Set(["plan_chosen", "flight_started", "sweep_started", "mission_ended"]);

/** Up to where events are folded; null: all. */
export const momentSeq = computed<number | null>(() => (cursor.value === null ? null : settledSeq(events.value, cursor.value)));

const stateNow = computed(() => live.value.mission);
const stateThen = computed(() => (momentSeq.value === null ? stateNow.value : missionAt(events.value, momentSeq.value)));

/** All craft that fly, or flew, for the mission. */
export const craftIds = computed<readonly string[]>(() => [...stateNow.value.crafts.keys()]);

/** By id, at the moment looked at. */
export const emittersThen = computed(() => stateThen.value.emitters);

export const liveMission = computed<MissionView>(() => viewOf(stateNow.value, selectedCraft.value, selectedEmitter.value));

export const happened = computed<MissionView>(() =>
  cursor.value === null ? liveMission.value : viewOf(stateThen.value, selectedCraft.value, selectedEmitter.value),
);

/** UTC of the event looked at, ms; null while live. */
export const reviewTimeMs = computed<number | null>(() => {
  if (cursor.value === null) return null;
  const at = events.value.findLast((e) => e.seq <= cursor.value!)?.at_utc;
  return at === undefined ? null : Date.parse(at);
});

export function look(seq: number | null): void {
  cursor.value = seq;
}
