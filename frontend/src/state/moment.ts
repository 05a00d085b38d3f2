// The moment looked at: now, or an event of the past, and the mission as it stood then.
import { computed, signal } from "@preact/signals";
import { live } from "./connection";
import { missionAt } from "./mission";
import { selectedCraft, selectedEmitter } from "./selection";
import { type MissionView, viewOf } from "./view";

/** Sequence number of the event looked at; null: now. */
export const cursor = signal<number | null>(null);

export const events = computed(() => live.value.events);

const stateNow = computed(() => live.value.mission);
const stateThen = computed(() => (cursor.value === null ? stateNow.value : missionAt(events.value, cursor.value)));

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
