// Does the battery last until it is localized and home again? Percent of charge against seconds of flight.
import type { MissionSpec } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { polygonsOf } from "./areas";
import { distanceM } from "./geometry";

/** Before a flight has shown it: twenty minutes from full to empty; a minute to land. */
const NOMINAL_DRAIN_PERCENT_S = 100 / 1200;
const LANDING_S = 60;

export interface Budget {
  chargePercent: number;
  drainPercentS: number;
  /** Kept for the way home and the reserve. */
  keptPercent: number;
}

/** In flight: `toReturnPercent` is the server's figure for the way home from `distanceHomeM`; its drain follows from it. */
export function flightBudget(chargePercent: number, toReturnPercent: number, distanceHomeM: number, spec: MissionSpec): Budget {
  const homeS = distanceHomeM / spec.flight.speed_m_s + LANDING_S;
  return { chargePercent, drainPercentS: toReturnPercent / homeS, keptPercent: toReturnPercent + spec.flight.reserve_battery_percent };
}

/** Before take-off: from the charge now to the way home from the area's farthest corner. */
export function plannedBudget(chargePercent: number, home: LonLat, spec: MissionSpec): Budget {
  const farthestM = Math.max(
    ...polygonsOf(spec.area)
      .flat(2)
      .map((corner) => distanceM(home, corner)),
  );
  const homeS = farthestM / spec.flight.speed_m_s + LANDING_S;
  const drainPercentS = NOMINAL_DRAIN_PERCENT_S;
  return { chargePercent, drainPercentS, keptPercent: drainPercentS * homeS + spec.flight.reserve_battery_percent };
}

export const chargeAfter = (budget: Budget, seconds: number): number => budget.chargePercent - budget.drainPercentS * seconds;

export const lasts = (budget: Budget, seconds: number): boolean => chargeAfter(budget, seconds) >= budget.keptPercent;

/** Share of the simulated searches that end before the charge must go home, 0 to 1. */
export const coveredShare = (budget: Budget, timesS: readonly number[]): number =>
  timesS.filter((time) => lasts(budget, time)).length / timesS.length;
