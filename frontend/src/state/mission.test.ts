import { describe, expect, it } from "vitest";
import { phase, record, someBearing, somePlan, someSpec } from "./examples";
import { emptyMission, foldMission, inFlight, isOver, missionAt, suppose } from "./mission";
import type { BeliefUpdated, MissionEvent, Polygon } from "../wire";

const fold = (...events: MissionEvent[]) => missionAt(record(...events), Infinity);

describe("the mission as a fold of its events", () => {
  it("is the same whether events come once or again after a reconnect", () => {
    const events = record({ kind: "mission_drafted", spec: someSpec() }, phase("flying"), someBearing());
    const once = missionAt(events, Infinity);
    const twice = [...events, ...events].reduce(foldMission, emptyMission);
    expect(twice).toEqual(once);
  });

  it("at an earlier event equals the fold of the events up to it", () => {
    const events = record({ kind: "mission_drafted", spec: someSpec() }, somePlan(), someBearing(), phase("hold", "x"));
    for (let seq = 0; seq <= events.length; seq++) {
      expect(missionAt(events, seq)).toEqual(events.slice(0, seq).reduce(foldMission, emptyMission));
    }
  });

  it("marks a bearing that was left out, and only that one", () => {
    const state = fold(
      someBearing({ bearing_id: "a" }),
      someBearing({ bearing_id: "b" }),
      { kind: "bearing_excluded", bearing_id: "a", by: "operator", reason: "" },
    );
    expect(state.bearings.map((b) => [b.fact.bearing_id, b.excluded])).toEqual([["a", true], ["b", false]]); // prettier-ignore
  });

  it("forgets the plan that was vetoed", () => {
    expect(fold(somePlan(), { kind: "plan_vetoed", place: { lat: 1, lon: 2 }, by: "operator" }).plan).toBeNull();
  });

  it("keeps the pilot's control until it is released", () => {
    const taken = fold({ kind: "control_taken", mode: "POSCTL", detail: "sticks" });
    expect(taken.pilot?.mode).toBe("POSCTL");
    expect(fold({ kind: "control_taken", mode: "POSCTL", detail: "" }, { kind: "control_released", by: "o" }).pilot).toBeNull();
  });

  it("knows which links are down now", () => {
    const lost = { kind: "link_lost", link: "receiver", detail: "silent" } as const;
    expect(Object.keys(fold(lost).lost)).toEqual(["receiver"]);
    expect(fold(lost, { kind: "link_restored", link: "receiver", outage_s: 4 }).lost).toEqual({});
  });

  it("follows an alert from raised to acknowledged to over", () => {
    const raised = { kind: "alert_raised", alert_id: "q", level: "caution", text: "x", remedy: "y" } as const;
    const state = fold(raised, { kind: "alert_acknowledged", alert_id: "q", by: "o" }, { kind: "alert_cleared", alert_id: "q" });
    expect(state.alerts).toMatchObject([{ id: "q", acknowledgedBy: "o", cleared: true }]);
  });

  it("raises an alert of the same id anew, unacknowledged", () => {
    const raised = { kind: "alert_raised", alert_id: "q", level: "caution", text: "x", remedy: "y" } as const;
    const state = fold(raised, { kind: "alert_acknowledged", alert_id: "q", by: "o" }, raised);
    expect(state.alerts).toMatchObject([{ id: "q", acknowledgedBy: null }]);
  });

  it("takes back the checks when the specification changes", () => {
    const checked: MissionEvent = { kind: "preflight_checked", passed: true, checks: [] };
    const edited = { kind: "mission_edited", spec: someSpec() } as const;
    expect(fold(checked).preflightPassed).toBe(true);
    expect(fold(checked, edited).preflightPassed).toBeNull();
  });

  it("keeps the bearings and forgets the plan when the search area changes in flight", () => {
    const spec = someSpec();
    const area: Polygon = { type: "Polygon", coordinates: [[[7.1, 50.7], [7.2, 50.7], [7.2, 50.8], [7.1, 50.7]]] }; // prettier-ignore
    const search = { area, prior: spec.prior, fence: null, fence_margin_m: 99, no_fly: [area] };
    const state = fold({ kind: "mission_drafted", spec }, someBearing(), somePlan(), { kind: "area_changed", search, by: "o" });
    expect(state.spec).toEqual({ ...spec, area, flight: { ...spec.flight, fence: null, fence_margin_m: 99, no_fly: [area] } });
    expect(state).toMatchObject({ specSeq: 4, plan: null });
    expect(state.bearings).toHaveLength(1);
  });
});

it("a mission flies or is over, never both", () => {
  for (const p of ["draft", "ready", "hold", "manual", "measuring", "done", "aborted", "failed"] as const) {
    expect(inFlight(p) && isOver(p)).toBe(false);
  }
  expect(inFlight("hold")).toBe(true);
  expect(inFlight("ready")).toBe(false);
});

it("shows what the sweeps would have told in the place of what they told, each at its own moment", () => {
  const flown = fold(
    someBearing({ bearing_id: "a", sweep_id: "sa" }),
    someBearing({ bearing_id: "b", sweep_id: "sb" }),
    someBearing({ bearing_id: "c", sweep_id: "sc" }),
    { kind: "bearing_excluded", bearing_id: "c", by: "operator", reason: "" },
  );
  const nothing = { kind: "sweep_rejected", sweep_id: "sb", place_number: 2, attempt: 1, quality: 0.1, reason: "x", place: { lat: 1, lon: 2 }, binned_db: [], fitted_db: [] } as const;
  const belief = { kind: "belief_updated", bearings: 1 } as BeliefUpdated;
  const state = suppose(flown, { belief, plan: null, sweeps: [someBearing({ sweep_id: "sa", bearing_deg: 70 }), { ...nothing, binned_db: [], fitted_db: [] }] });
  expect(state.bearings.map((b) => [b.fact.bearing_deg, b.seq, b.excluded])).toEqual([[70, 1, false], [45, 3, true]]); // prettier-ignore
  expect(state.rejected.map((r) => [r.fact.sweep_id, r.seq])).toEqual([["sb", 2]]);
  expect(state.belief?.fact).toBe(belief);
  expect(state.plan).toBeNull();
});
