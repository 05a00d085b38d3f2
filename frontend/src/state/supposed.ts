// A decision of the review, computed again with another sensor or planner: shown in place of what happened, never flown.
import { computed, signal } from "@preact/signals";
import type { WhatIf } from "../wire";
import type { BeliefFrame } from "../wire/beliefFrame";
import { cursor, happened } from "./moment";

export interface Supposed {
  missionId: string;
  /** Counted bearings after which the decision is taken, and legs. */
  bearings: number;
  legs: number;
  answer: WhatIf;
  frame: BeliefFrame;
}

export const supposed = signal<Supposed | null>(null);

/** The bearings that count at the moment shown, as they were flown. */
export const flownBearings = computed(() => happened.value.bearings.filter((b) => !b.excluded).map((b) => b.fact));

/** The legs that count then. */
export const flownLegs = computed(() => happened.value.ways.filter((w) => !w.excluded).length);

/** Only in the review, only for the emitter asked about, and only where as many bearings and legs count as the question had. */
export const supposedHere = computed<Supposed | null>(() => {
  const what = supposed.value;
  if (!what || cursor.value === null || what.missionId !== happened.value.missionId) return null;
  if (what.answer.belief.emitter_id !== happened.value.emitterId) return null;
  return flownBearings.value.length === what.bearings && flownLegs.value === what.legs ? what : null;
});
