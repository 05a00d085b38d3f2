import { describe, expect, it } from "vitest";
import type { MissionSpec } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { someSpec } from "../wire/examples";
import { chargeAfter, coveredShare, flightBudget, lasts, plannedBudget } from "./budget";
import { destination } from "./geometry";

const home: LonLat = [7.1, 50.73];
const corner = destination(home, 0, 420);
const example = someSpec();
const spec: MissionSpec = {
  ...example,
  area: { type: "Polygon", coordinates: [[home, destination(home, 90, 100), corner, home]] },
  flight: { ...example.flight, speed_m_s: 7, reserve_battery_percent: 25 },
};

describe("the battery's budget", () => {
  it("takes the drain from what the server says the way home costs", () => {
    const budget = flightBudget(80, 10, 280, spec);
    expect(budget.drainPercentS).toBeCloseTo(0.1);
    expect(budget.keptPercent).toBe(35);
    expect(chargeAfter(budget, 100)).toBeCloseTo(70);
    expect([lasts(budget, 449), lasts(budget, 451)]).toEqual([true, false]);
  });

  it("keeps the way home from the farthest corner before take-off", () => {
    const budget = plannedBudget(100, home, spec);
    expect(budget.keptPercent).toBeCloseTo(25 + 120 / 12, 0);
  });

  it("counts the simulated searches that it covers", () => {
    const budget = flightBudget(80, 10, 280, spec);
    expect(coveredShare(budget, [100, 200, 449, 500])).toBe(0.75);
  });
});
