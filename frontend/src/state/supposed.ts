// A decision of the review, computed again with another sensor or planner: shown in place of what happened, never flown.
import { computed, signal } from "@preact/signals";
import type { WhatIf } from "../wire";
import type { BeliefFrame } from "../wire/beliefFrame";
import { cursor, happened } from "./moment";

export interface Supposed {
  missionId: string;
  /** What counted when the decision was taken. */
  counted: string;
  answer: WhatIf;
  frame: BeliefFrame;
}

export const supposed = signal<Supposed | null>(null);

/** The bearings that count at the moment shown, as they were flown. */
export const flownBearings = computed(() => happened.value.bearings.filter((b) => !b.excluded).map((b) => b.fact));

/** By their ids, the bearings and legs that count then. */
export const countedThen = computed(() =>
  [...flownBearings.value.map((b) => b.bearing_id), ...happened.value.ways.filter((w) => !w.excluded).map((w) => w.fact.leg_id)].join(),
);

/** Only in the review, only for the emitter asked about, and only where the same bearings and legs count. */
export const supposedHere = computed<Supposed | null>(() => {
  const what = supposed.value;
  if (!what || cursor.value === null || what.missionId !== happened.value.missionId) return null;
  if (what.answer.belief.emitter_id !== happened.value.emitterId) return null;
  return countedThen.value === what.counted ? what : null;
});
