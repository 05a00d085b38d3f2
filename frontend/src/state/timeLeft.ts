// "Localized in about ...": the plan's expectation, counted down while the search goes on.
import { pausedMs } from "./craft";
import { isHomeward } from "./mission";
import type { MissionView } from "./view";

export interface TimeLeft {
  meanS: number;
  /** Not exceeded by nine of ten searches; null when not sampled. */
  worstS: number | null;
}

/** Null without a plan, once it goes home, and when the planner gave no time. */
export function remainingTime(mission: MissionView, timeMs: number): TimeLeft | null {
  const { plan, belief } = mission;
  if (!plan || belief?.fact.localized || isHomeward(mission)) return null;
  const { expected_time_s: mean, time_90_s: worst } = plan.fact;
  if (mean === null) return null;
  const elapsed = elapsedS(mission, plan, timeMs);
  return { meanS: Math.max(0, mean - elapsed), worstS: worst === null ? null : Math.max(0, worst - elapsed) };
}

const elapsedS = (mission: MissionView, plan: { at: string }, timeMs: number): number =>
  Math.max(0, (timeMs - Date.parse(plan.at) - pausedMs(mission, timeMs)) / 1000);

/** Seconds by emitter id, of a plan for several: each if it were flown for by itself from the place on. */
export function remainingTimes(mission: MissionView, timeMs: number): ReadonlyMap<string, number> {
  const { plan } = mission;
  if (!plan || isHomeward(mission)) return new Map();
  const elapsed = elapsedS(mission, plan, timeMs);
  return new Map(
    (plan.fact.forecasts ?? []).flatMap(({ emitter_id: id, expected_time_s: mean }) =>
      mean === null ? [] : [[id, Math.max(0, mean - elapsed)] as const],
    ),
  );
}
