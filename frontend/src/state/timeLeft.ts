// "Localized in about ...": the plan's expectation, counted down since it was made.
import type { PlanChosen } from "../wire";
import type { At } from "./mission";

export interface TimeLeft {
  meanS: number;
  /** Not exceeded in 90 % of the rollouts; null when not sampled. */
  worstS: number | null;
}

export function remainingTime(plan: At<PlanChosen>, timeMs: number): TimeLeft | null {
  const { expected_time_s: mean, time_90_s: worst } = plan.fact;
  if (mean === null) return null;
  const elapsed = Math.max(0, (timeMs - Date.parse(plan.at)) / 1000);
  return { meanS: Math.max(0, mean - elapsed), worstS: worst === null ? null : Math.max(0, worst - elapsed) };
}
