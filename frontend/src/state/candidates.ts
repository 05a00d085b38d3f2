// The candidates of a plan in the order one reads them, and how they are shaded by the round that dropped them.
import type { CandidateFact, PlanChosen } from "../wire";
import type { MissionView } from "./view";

export interface Ranked {
  candidate: CandidateFact;
  index: number;
  chosen: boolean;
}

/** Shades 0 (dropped first, faint) .. 4 (survived), 5: chosen; the page's style gives them colours. */
export const SHADES = 4;

const samePlace = (a: { lat: number; lon: number }, b: { lat: number; lon: number }) =>
  Math.abs(a.lat - b.lat) < 1e-7 && Math.abs(a.lon - b.lon) < 1e-7;

export function rankCandidates(plan: PlanChosen): Ranked[] {
  return plan.candidates
    .map((candidate, index) => ({ candidate, index, chosen: samePlace(candidate, plan.place) }))
    .toSorted(
      (a, b) =>
        Number(b.chosen) - Number(a.chosen) ||
        (b.candidate.dropped_in_round ?? Infinity) - (a.candidate.dropped_in_round ?? Infinity) ||
        a.candidate.value_s - b.candidate.value_s,
    );
}

export function roundShade(candidate: CandidateFact, plan: PlanChosen, chosen: boolean): number {
  if (chosen) return SHADES + 1;
  if (candidate.dropped_in_round === null) return SHADES;
  const last = Math.max(1, ...plan.candidates.map((c) => c.dropped_in_round ?? 0));
  return Math.min(SHADES - 1, Math.floor(((candidate.dropped_in_round - 1) / last) * SHADES));
}

/** Whether the plan's places are still to be chosen among: not while a bearing is taken at one of them, nor after it was. */
export function isChoosing({ phase, plan, bearings, rejected }: Pick<MissionView, "phase" | "plan" | "bearings" | "rejected">): boolean {
  const heard = [...bearings, ...rejected].filter(({ fact }) => !("source" in fact) || fact.source.kind === "craft");
  return plan !== null && phase !== "measuring" && heard.every(({ seq }) => seq <= plan.seq);
}
