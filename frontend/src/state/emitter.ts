// What is known of one emitter: a fold of the mission's events.
import type { BearingMeasured, BearingSource, BeliefUpdated, HeardOnTheWay, MissionEvent, SweepRejected, TruthNoted } from "../wire";

export interface At<T> {
  fact: T;
  seq: number;
  at: string;
}

export interface Bearing extends At<BearingMeasured> {
  /** By itself; else it does not count because its source is muted. */
  leftOut: boolean;
  /** It does not count. */
  excluded: boolean;
}

export interface Rejected extends At<SweepRejected> {
  /** It heard nothing, and somebody left out what that tells. */
  excluded: boolean;
}

/** A leg on which the emitter was listened to. */
export interface Way extends At<HeardOnTheWay> {
  leftOut: boolean;
  /** It does not count: left out, or its source is muted. */
  excluded: boolean;
}

export type MutedSources = ReadonlySet<string>;

/** One name for each source, as a muted one is remembered by. */
export function sourceKey(source: BearingSource): string {
  switch (source.kind) {
    case "craft":
      return `craft:${source.craft_id}`;
    case "import":
      return `import:${source.recording_id}`;
    case "person":
      return `person:${source.name}`;
  }
}

export interface BeliefPoint {
  seq: number;
  at: string;
  bearings: number;
  expectedRmse: number | null;
}

export interface EmitterState {
  emitterId: string;
  /** Whose bearings do not count. */
  muted: MutedSources;
  bearings: readonly Bearing[];
  rejected: readonly Rejected[];
  ways: readonly Way[];
  belief: At<BeliefUpdated> | null;
  beliefs: readonly BeliefPoint[];
  /** The last belief that said localized: of an emitter that moves it stands for its moment. */
  claim: At<BeliefUpdated> | null;
  /** What was told of its place after the flight, the last word. */
  truth: At<TruthNoted> | null;
}

export const emptyEmitter = (emitterId: string, muted: MutedSources = new Set()): EmitterState => ({
  emitterId,
  muted,
  bearings: [],
  rejected: [],
  ways: [],
  belief: null,
  beliefs: [],
  claim: null,
  truth: null,
});

const counting = <T extends { leftOut: boolean; fact: { source: BearingSource } }>(
  told: T,
  muted: MutedSources,
): T & { excluded: boolean } => ({
  ...told,
  excluded: told.leftOut || muted.has(sourceKey(told.fact.source)),
});

const leaving = (state: EmitterState, bearingId: string, leftOut: boolean): EmitterState => ({
  ...state,
  claim: null,
  bearings: state.bearings.map((b) => (b.fact.bearing_id === bearingId ? counting({ ...b, leftOut }, state.muted) : b)),
  ways: state.ways.map((w) => (w.fact.leg_id === bearingId ? counting({ ...w, leftOut }, state.muted) : w)),
  rejected: state.rejected.map((r) => (r.fact.sweep_id === bearingId ? { ...r, excluded: leftOut } : r)),
});

/** What was claimed was claimed of other bearings, where the source told anything. */
export function muteEmitter(state: EmitterState, muted: MutedSources): EmitterState {
  const bearings = state.bearings.map((b) => counting(b, muted));
  const ways = state.ways.map((w) => counting(w, muted));
  const changed =
    bearings.some((b, index) => b.excluded !== state.bearings[index]!.excluded) ||
    ways.some((w, index) => w.excluded !== state.ways[index]!.excluded);
  return { ...state, muted, bearings, ways, claim: changed ? null : state.claim };
}

/** `event` is one that speaks of this emitter. */
export function foldEmitter(state: EmitterState, event: MissionEvent, seq: number, at: string): EmitterState {
  switch (event.kind) {
    case "sweep_rejected":
      return { ...state, rejected: [...state.rejected, { fact: event, seq, at, excluded: false }] };
    case "bearing_measured":
      return { ...state, bearings: [...state.bearings, counting({ fact: event, seq, at, leftOut: false }, state.muted)] };
    case "heard_on_the_way":
      return { ...state, ways: [...state.ways, counting({ fact: event, seq, at, leftOut: false }, state.muted)] };
    case "bearing_excluded":
      return leaving(state, event.bearing_id, true);
    case "bearing_included":
      return leaving(state, event.bearing_id, false);
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
