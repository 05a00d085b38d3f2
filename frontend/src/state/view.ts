// A mission as one craft and one emitter show it: what the panels and the map draw. With one of each that is all of it.
import type { LinkName, MissionPhase, PlanChosen, Reason, WhatIf } from "../wire";
import { type CraftState, emptyCraft, type Lost, pilotHas } from "./craft";
import { type At, type Bearing, type BeliefPoint, type EmitterState, emptyEmitter, type Rejected, type Way } from "./emitter";
import { groupsOf } from "./importance";
import type { MissionState } from "./mission";

export interface Pilot {
  /** The mode in which they took control; null: with the sticks. */
  mode: string | null;
  since: string | null;
}

export interface MissionView extends Omit<MissionState, "emitters" | "crafts" | "placeNumber"> {
  /** null: none flew for the mission so far. */
  craftId: string | null;
  /** null: nothing is known of the mission. */
  emitterId: string | null;
  phase: MissionPhase;
  phaseReason: Reason | null;
  phaseSince: string | null;
  plan: At<PlanChosen> | null;
  pausedMs: number;
  placeNumber: number | null;
  /** The number that the next place gets. */
  nextPlaceNumber: number;
  attempt: number;
  bearings: readonly Bearing[];
  rejected: readonly Rejected[];
  ways: readonly Way[];
  belief: EmitterState["belief"];
  beliefs: readonly BeliefPoint[];
  truth: EmitterState["truth"];
  automatic: boolean;
  returnsAt: CraftState["returnsAt"];
  authority: CraftState["authority"];
  pilot: Pilot | null;
  lost: Readonly<Partial<Record<LinkName, Lost>>>;
}

/**
 * What the craft does while it flies, else the stage of the search. Of a search that has ended its outcome, unless its
 * craft stands still in the air and waits for somebody.
 */
function phaseOf({ ended, startedAt, preflightPassed }: MissionState, craft: CraftState): MissionPhase {
  const waits = craft.engaged && (craft.phase === "hold" || craft.phase === "manual");
  if (ended && !waits) {
    const { outcome } = ended.fact;
    return outcome === "localized" || outcome === "not_localized" ? "done" : outcome;
  }
  if (craft.engaged && craft.phase !== "ground") return craft.phase;
  if (!craft.engaged && craft.phaseSince !== null) return "ground";
  return startedAt !== null ? "searching" : preflightPassed ? "ready" : "draft";
}

const chosen = <T>(known: ReadonlyMap<string, T>, id: string | null | undefined): T | null =>
  known.get(id ?? "") ?? known.values().next().value ?? null;

/** Of this craft and this emitter; one that the mission does not have, or none, means its first, or most important. */
export function viewOf(state: MissionState, craftId?: string | null, emitterId?: string | null): MissionView {
  const { emitters, crafts, placeNumber, ...search } = state;
  const knownCraft = chosen(crafts, craftId);
  const mostImportant = groupsOf(state.spec?.emitters ?? [])[0]?.[0];
  const knownEmitter = chosen(emitters, emitters.has(emitterId ?? "") ? emitterId : mostImportant);
  const { engaged: _engaged, authoritySince, ...craft } = knownCraft ?? emptyCraft("", state.spec?.flight.automatic ?? true);
  return {
    ...search,
    ...(knownEmitter ?? emptyEmitter("")),
    ...craft,
    craftId: knownCraft?.craftId ?? null,
    emitterId: knownEmitter?.emitterId ?? null,
    phase: phaseOf(state, knownCraft ?? emptyCraft("", true)),
    nextPlaceNumber: placeNumber + 1,
    pilot: pilotHas(craft.authority) ? { mode: craft.authority.mode, since: authoritySince } : null,
  };
}

/** The same mission with what its sweeps would have told, another belief and another choice at its last moment. */
export function suppose(view: MissionView, { belief, plan, sweeps }: Pick<WhatIf, "belief" | "plan" | "sweeps">): MissionView {
  const [seq, at] = [view.lastSeq, view.belief?.at ?? view.startedAt ?? ""];
  const flown = new Map([...view.bearings, ...view.rejected].map((s) => [s.fact.sweep_id, s]));
  const of = (id: string | null) => ({ seq: flown.get(id)?.seq ?? seq, at: flown.get(id)?.at ?? at });
  const told = sweeps.flatMap((fact) =>
    fact.kind === "bearing_measured" ? [{ ...of(fact.sweep_id), fact, leftOut: false, excluded: false }] : [],
  );
  return {
    ...view,
    bearings: [...told, ...view.bearings.filter((b) => b.excluded)],
    rejected: sweeps.flatMap((fact) => (fact.kind === "sweep_rejected" ? [{ ...of(fact.sweep_id), fact, excluded: false }] : [])),
    belief: { fact: belief, seq, at },
    plan: plan && { fact: plan, seq, at },
  };
}
