import { expect, it } from "vitest";
import type { BeliefUpdated, MissionEvent, Reason, SweepRejected } from "../wire";
import { CRAFT, EMITTER, excluded, record, someBearing, someBelief, someReason, someSpec } from "../wire/examples";
import { missionAt } from "./mission";
import { notYet } from "./notYet";
import { suppose, viewOf } from "./view";

const seen = (...events: MissionEvent[]) => viewOf(missionAt(record(...events), Infinity));

it("shows what the sweeps would have told in the place of what they told, each at its own moment", () => {
  const flown = seen(
    someBearing({ bearing_id: "a", sweep_id: "sa" }),
    someBearing({ bearing_id: "b", sweep_id: "sb" }),
    someBearing({ bearing_id: "c", sweep_id: "sc" }),
    excluded("c"),
  );
  const nothing: SweepRejected = {
    kind: "sweep_rejected",
    emitter_id: EMITTER,
    source: { kind: "craft", craft_id: CRAFT },
    sweep_id: "sb",
    place_number: 2,
    attempt: 1,
    quality: 0.1,
    reason: someReason,
    place: { lat: 1, lon: 2 },
    binned_db: [],
    fitted_db: [],
    likelihood: null,
    silence: null,
    turn: null,
  };
  const belief = { kind: "belief_updated", emitter_id: EMITTER, bearings: 1 } as BeliefUpdated;
  const state = suppose(flown, {
    belief,
    plan: null,
    sweeps: [someBearing({ sweep_id: "sa", bearing_deg: 70 }), nothing],
  });
  expect(state.bearings.map((b) => [b.fact.bearing_deg, b.seq, b.excluded])).toEqual([
    [70, 1, false],
    [45, 3, true],
  ]);
  expect(state.rejected.map((r) => [r.fact.sweep_id, r.seq])).toEqual([["sb", 2]]);
  expect(state.belief?.fact).toBe(belief);
  expect(state.plan).toBeNull();
});

it("shows the most important emitter unless another one is chosen, and follows the order as it changes", () => {
  const spec = someSpec();
  const [one] = spec.emitters;
  const emitters = ["a", "b"].map((id) => ({ ...one!, emitter_id: id, priority: null }));
  const drafted: MissionEvent = { kind: "mission_drafted", spec: { ...spec, emitters } };
  const ordered: MissionEvent = { kind: "priorities_changed", priorities: { b: 1 }, by: "o" };
  expect(seen(drafted).emitterId).toBe("a");
  expect(seen(drafted, ordered).emitterId).toBe("b");
  expect(seen(drafted, ordered).spec?.emitters.map((e) => e.priority)).toEqual([null, 1]);
  expect(viewOf(missionAt(record(drafted, ordered), Infinity), null, "a").emitterId).toBe("a");
  expect(seen(drafted, ordered, { ...ordered, priorities: {} }).emitterId).toBe("a");
});

it("says of bearings that no belief contains that they are not in it, and not that there are none", () => {
  const none: Reason = { code: "no_bearing_yet" };
  const prior = someBelief({ bearings: 0, localized: false, not_yet: [none] });
  expect(notYet(seen())).toEqual([]);
  expect(notYet(seen(prior))).toEqual([none]);
  const [one, two] = [someBearing({ bearing_id: "a" }), someBearing({ bearing_id: "b" })];
  expect(notYet(seen(one))).toEqual([{ code: "bearings_not_in_belief", bearings: 1 }]);
  expect(notYet(seen(prior, one, two))).toEqual([{ code: "bearings_not_in_belief", bearings: 2 }]);
  expect(notYet(seen(prior, one, two, excluded("b")))).toEqual([{ code: "bearings_not_in_belief", bearings: 1 }]);
  expect(notYet(seen(prior, one, excluded("a")))).toEqual([none]);
  const first = someBelief({ bearings: 1, localized: false, not_yet: [someReason] });
  expect(notYet(seen(prior, one, first, two))).toEqual([someReason]);
  expect(notYet(seen(one, { ...first, localized: true }))).toEqual([]);
});
