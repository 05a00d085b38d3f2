// What is known of one emitter: a fold of the mission's events.
import type { BearingMeasured, BeliefUpdated, MissionEvent, SweepRejected, TruthNoted } from "../wire";

export interface At<T> {
  fact: T;
  seq: number;
  at: string;
}

export interface Bearing extends At<BearingMeasured> {
  excluded: boolean;
}

export interface Rejected extends At<SweepRejected> {
  /** It heard nothing, and somebody left out what that tells. */
  excluded: boolean;
}

export interface BeliefPoint {
  seq: number;
  at: string;
  bearings: number;
  expectedRmse: number | null;
}

export interface EmitterState {
  emitterId: string;
  bearings: readonly Bearing[];
  rejected: readonly Rejected[];
  belief: At<BeliefUpdated> | null;
  beliefs: readonly BeliefPoint[];
  /** The last belief that said localized: of an emitter that moves it stands for its moment. */
  claim: At<BeliefUpdated> | null;
  /** What was told of its place after the flight, the last word. */
  truth: At<TruthNoted> | null;
}

export const emptyEmitter = (emitterId: string): EmitterState => ({
  emitterId,
  bearings: [],
  rejected: [],
  belief: null,
  beliefs: [],
  claim: null,
  truth: null,
});

/** `event` is one that speaks of this emitter. */
export function foldEmitter(state: EmitterState, event: MissionEvent, seq: number, at: string): EmitterState {
  switch (event.kind) {
    case "sweep_rejected":
      return { ...state, rejected: [...state.rejected, { fact: event, seq, at, excluded: false }] };
    case "bearing_measured":
      return { ...state, bearings: [...state.bearings, { fact: event, seq, at, excluded: false }] };
    case "bearing_excluded":
      return {
        ...state,
        claim: null,
        bearings: state.bearings.map((b) => (b.fact.bearing_id === event.bearing_id ? { ...b, excluded: true } : b)),
        rejected: state.rejected.map((r) => (r.fact.sweep_id === event.bearing_id ? { ...r, excluded: true } : r)),
      };
    case "truth_noted":
      return { ...state, truth: { fact: event, seq, at } };
    case "belief_updated":
      return {
        ...state,
        belief: { fact: event, seq, at },
        claim: event.localized ? { fact: event, seq, at } : state.claim,
        beliefs: [...state.beliefs, { seq, at, bearings: event.bearings, expectedRmse: event.estimate?.expected_rmse_m ?? null }],
      };
    default:
      return state;
  }
}
