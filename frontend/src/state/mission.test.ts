import { describe, expect, it } from "vitest";
import type { AlertTopic, EventOf, MissionEvent, MissionSpec, Polygon } from "../wire";
import {
  CRAFT,
  EMITTER,
  ended,
  excluded,
  flown,
  included,
  mute,
  NOBODY,
  person,
  phase,
  record,
  someBearing,
  someBelief,
  someLeg,
  somePlan,
  someReason,
  someSpec,
  started,
} from "../wire/examples";
import { emptyMission, foldMission, inFlight, isOver, missionAt } from "./mission";
import { viewOf } from "./view";

const fold = (...events: MissionEvent[]) => missionAt(record(...events), Infinity);
const seen = (...events: MissionEvent[]) => viewOf(fold(...events));

const raised = (topic: AlertTopic = "receiver", changes: Partial<EventOf<"alert_raised">> = {}): EventOf<"alert_raised"> => ({
  kind: "alert_raised",
  alert_id: "q",
  topic,
  level: "caution",
  reason: someReason,
  craft_id: CRAFT,
  emitter_id: null,
  ...changes,
});
const acknowledged: MissionEvent = { kind: "alert_acknowledged", alert_id: "q", by: "o" };
const cleared: MissionEvent = { kind: "alert_cleared", alert_id: "q" };
const lost: MissionEvent = { kind: "link_lost", craft_id: CRAFT, link: "receiver", reason: someReason };

describe("the mission as a fold of its events", () => {
  it("is the same whether events come once or again after a reconnect", () => {
    const events = record({ kind: "mission_drafted", spec: someSpec() }, phase("flying"), someBearing());
    const once = missionAt(events, Infinity);
    const twice = [...events, ...events].reduce(foldMission, emptyMission);
    expect(twice).toEqual(once);
  });

  it("at an earlier event equals the fold of the events up to it", () => {
    const events = record({ kind: "mission_drafted", spec: someSpec() }, somePlan(), someBearing(), phase("hold"));
    for (let seq = 0; seq <= events.length; seq++) {
      expect(missionAt(events, seq)).toEqual(events.slice(0, seq).reduce(foldMission, emptyMission));
    }
  });

  it("marks a bearing that was left out, and only that one", () => {
    const state = seen(someBearing({ bearing_id: "a" }), someBearing({ bearing_id: "b" }), excluded("a"));
    expect(state.bearings.map((b) => [b.fact.bearing_id, b.excluded])).toEqual([
      ["a", true],
      ["b", false],
    ]);
  });

  it("counts a bearing again that was left out, and no other way", () => {
    const [a, b] = [someBearing({ bearing_id: "a" }), someBearing({ bearing_id: "b" })];
    expect(seen(a, b, excluded("a"), included("a")).bearings.map((one) => one.excluded)).toEqual([false, false]);
    expect(seen(a, b, excluded("a"), excluded("b"), included("a")).bearings.map((one) => one.excluded)).toEqual([false, true]);
  });

  it("counts nothing of a muted source, whenever it comes, and what was left out by itself not after it either", () => {
    const [ada, ben] = [person("Ada"), person("Ben")];
    const events = [
      someBearing({ bearing_id: "a", source: ada }),
      someBearing({ bearing_id: "b", source: ben }),
      someBearing({ bearing_id: "c", source: ada }),
      excluded("c"),
      mute(ada, true),
      someBearing({ bearing_id: "d", source: ada }),
    ];
    const counts = (state: ReturnType<typeof seen>) => state.bearings.filter((one) => !one.excluded).map((one) => one.fact.bearing_id);
    expect(counts(seen(...events))).toEqual(["b"]);
    expect(counts(seen(...events, mute(ada, false)))).toEqual(["a", "b", "d"]);
    expect(counts(seen(...events, included("c")))).toEqual(["b"]);
  });

  it("takes a claim back with the muted bearings that it stood on, and with no others", () => {
    const claim = someBelief({ localized: true });
    const told = [someBearing({ bearing_id: "a", source: person("Ada") }), claim];
    const claimed = (...more: MissionEvent[]) => fold(...told, ...more).emitters.get(EMITTER)?.claim?.fact;
    expect(claimed(mute(person("Ada"), true))).toBeUndefined();
    expect(claimed(mute(person("Ben"), true))).toEqual(claim);
  });

  it("marks the silence of a turn that was left out, until it counts again", () => {
    const silent = (sweepId: string): MissionEvent => ({
      kind: "sweep_rejected",
      emitter_id: someBearing().emitter_id,
      source: someBearing().source,
      sweep_id: sweepId,
      place_number: 1,
      attempt: 1,
      quality: 0,
      reason: { code: "no_pulse_heard" },
      place: { lat: 1, lon: 2 },
      binned_db: [],
      fitted_db: [],
      likelihood: null,
      silence: { chances: [1], gain_db: [0] },
      turn: null,
    });
    const left = [silent("a"), silent("b"), { ...excluded("b"), heard: false }];
    expect(seen(...left).rejected.map((r) => r.excluded)).toEqual([false, true]);
    expect(seen(...left, included("b")).rejected.map((r) => r.excluded)).toEqual([false, false]);
  });

  it("marks a leg that was left out, or whose craft is muted, until it counts again", () => {
    const legs = [someLeg({ leg_id: "a" }), someLeg({ leg_id: "b" })];
    const counts = (...more: MissionEvent[]) => seen(...legs, ...more).ways.map((way) => !way.excluded);
    expect(counts()).toEqual([true, true]);
    expect(counts(excluded("b"))).toEqual([true, false]);
    expect(counts(excluded("b"), included("b"))).toEqual([true, true]);
    expect(counts(mute(someLeg().source, true))).toEqual([false, false]);
  });

  it("forgets the plan that was vetoed", () => {
    const vetoed: MissionEvent = { kind: "plan_vetoed", craft_id: CRAFT, place: { lat: 1, lon: 2 }, by: "operator" };
    expect(seen(somePlan(), vetoed).plan).toBeNull();
  });

  it("keeps the pilot's control, after their landing too, until an operator takes it back", () => {
    const changed = (changes: Partial<typeof NOBODY>, by: string | null = null): MissionEvent => ({
      kind: "authority_changed",
      craft_id: CRAFT,
      authority: { ...NOBODY, ...changes },
      by,
    });
    const taken = changed({ who: "pilot", taken_by: "mode", mode: "POSCTL" });
    expect(seen(taken).pilot?.mode).toBe("POSCTL");
    expect(seen(taken, changed({ who: "nobody", taken_by: "mode", mode: "POSCTL" })).pilot?.mode).toBe("POSCTL");
    expect(seen(taken, changed({ who: "ours" }, "o")).pilot).toBeNull();
    expect(seen(changed({ who: "pilot", taken_by: "sticks" })).pilot).toMatchObject({ mode: null });
  });

  it("does not take the autopilot's failsafe for a pilot", () => {
    const authority = { ...NOBODY, who: "failsafe", taken_by: "mode", mode: "RTL" } as const;
    const state = seen({ kind: "authority_changed", craft_id: CRAFT, authority, by: null });
    expect([state.authority.who, state.pilot]).toEqual(["failsafe", null]);
  });

  it("knows which links are down now, and nothing of them after the server's restart", () => {
    expect(Object.keys(seen(lost).lost)).toEqual(["receiver"]);
    expect(seen(lost, { kind: "link_restored", craft_id: CRAFT, link: "receiver", outage_s: 4 }).lost).toEqual({});
    expect(seen(lost, { kind: "server_restarted" }).lost).toEqual({});
  });

  it("follows an alert from raised to acknowledged to over", () => {
    expect(seen(raised(), acknowledged, cleared).alerts).toMatchObject([
      { id: "q", topic: "receiver", reason: someReason, craftId: CRAFT, emitterId: null, acknowledgedBy: "o", cleared: true },
    ]);
  });

  it("raises an alert of the same id again, unacknowledged", () => {
    expect(seen(raised(), acknowledged, raised()).alerts).toMatchObject([{ id: "q", acknowledgedBy: null }]);
  });

  it("takes back the checks when the specification changes", () => {
    const checked: MissionEvent = { kind: "preflight_checked", passed: true, checks: [] };
    const edited = { kind: "mission_edited", spec: someSpec(), by: "anna" } as const;
    expect(fold(checked).preflightPassed).toBe(true);
    expect(fold(checked, edited).preflightPassed).toBeNull();
  });

  it("keeps the bearings and forgets the plan when the search area changes in flight", () => {
    const spec = someSpec();
    const area: Polygon = {
      type: "Polygon",
      coordinates: [
        [
          [7.1, 50.7],
          [7.2, 50.7],
          [7.2, 50.8],
          [7.1, 50.7],
        ],
      ],
    };
    const prior = { kind: "ring", centre: { lat: 50.7, lon: 7.1 }, inner_m: 1, outer_m: 9 } as const;
    const search = { area, priors: { [EMITTER]: prior }, fence: null, fence_margin_m: 99, no_fly: [area] };
    const state = seen({ kind: "mission_drafted", spec }, someBearing(), somePlan(), { kind: "area_changed", search, by: "o" });
    expect(state.spec).toEqual({
      ...spec,
      area,
      emitters: [{ ...spec.emitters[0], prior }],
      flight: { ...spec.flight, fence: null, fence_margin_m: 99, no_fly: [area] },
    });
    expect(state).toMatchObject({ specSeq: 4, plan: null });
    expect(state.bearings).toHaveLength(1);
  });
});

const [one] = someSpec().emitters;
const TWO: MissionSpec = { ...someSpec(), emitters: [one!, { ...one!, emitter_id: "b" }] };

describe("several emitters and several craft", () => {
  it("are folded side by side, each from the facts that speak of it", () => {
    const ids = [CRAFT, "craft-2"] as const;
    const state = fold(
      { kind: "mission_drafted", spec: TWO },
      ...ids.map((craft_id) => started({ craft_id })),
      { ...phase("flying"), craft_id: ids[0] },
      { ...phase("hold"), craft_id: ids[1] },
      somePlan({ craft_id: ids[1], place_number: 2 }),
      someBearing({ bearing_id: "x" }),
      someBearing({ bearing_id: "y", emitter_id: "b", place_number: 5 }),
      someBelief({ emitter_id: "b", bearings: 1 }),
      { ...lost, craft_id: ids[1] } as MissionEvent,
    );
    expect([...state.emitters.keys()]).toEqual([EMITTER, "b"]);
    expect([...state.crafts.keys()]).toEqual(ids);
    const [first, second] = [viewOf(state, ids[0], EMITTER), viewOf(state, ids[1], "b")];
    expect([first.phase, first.plan, first.bearings.map((b) => b.fact.bearing_id), first.belief]).toEqual(["flying", null, ["x"], null]);
    expect([second.phase, second.placeNumber, second.bearings.map((b) => b.fact.bearing_id)]).toEqual(["hold", 2, ["y"]]);
    expect([second.belief?.fact.emitter_id, second.beliefs.map((b) => b.bearings)]).toEqual(["b", [1]]);
    expect([Object.keys(first.lost), Object.keys(second.lost)]).toEqual([[], ["receiver"]]);
    expect([first.nextPlaceNumber, second.nextPlaceNumber]).toEqual([6, 6]);
  });

  it("show the first of each unless another one is chosen that there is", () => {
    const state = fold({ kind: "mission_drafted", spec: TWO }, started(), started({ craft_id: "craft-2" }));
    const ids = (...chosen: (string | null)[]) => {
      const { craftId, emitterId } = viewOf(state, ...chosen);
      return [craftId, emitterId];
    };
    expect(ids()).toEqual([CRAFT, EMITTER]);
    expect(ids(null, "b")).toEqual([CRAFT, "b"]);
    expect(ids("craft-2", "nobody's")).toEqual(["craft-2", EMITTER]);
  });

  it("take their bearings with them when an emitter is no longer looked for", () => {
    const state = fold({ kind: "mission_drafted", spec: TWO }, someBearing({ emitter_id: "b" }), {
      kind: "mission_edited",
      spec: someSpec(),
      by: "anna",
    });
    expect([...state.emitters.keys()]).toEqual([EMITTER]);
  });

  it("change their plans together when the area changes, and who flies only one by one", () => {
    const spec = someSpec();
    const search = { area: spec.area, priors: {}, fence: null, fence_margin_m: 9, no_fly: [] };
    const authority = { ...NOBODY, who: "pilot", taken_by: "mode" } as const;
    const state = fold(
      { kind: "mission_drafted", spec },
      somePlan(),
      somePlan({ craft_id: "craft-2" }),
      { kind: "authority_changed", craft_id: "craft-2", authority, by: null },
      { kind: "area_changed", search, by: "o" },
    );
    expect([...state.crafts.values()].map((craft) => [craft.plan, craft.authority.who])).toEqual([
      [null, "nobody"],
      [null, "pilot"],
    ]);
  });
});

it("keeps the place that is flown to when a bearing comes from elsewhere", () => {
  const flying = [started(), somePlan({ place_number: 3 }), phase("flying")];
  const before = seen(...flying);
  for (const source of [{ kind: "person", name: "Ada" } as const, { kind: "import", recording_id: "r" } as const]) {
    const after = seen(...flying, someBearing({ source, place_number: 4 }));
    expect(after).toMatchObject({ phase: "flying", plan: before.plan, placeNumber: 3, attempt: 1 });
    expect(after.bearings).toHaveLength(1);
  }
});

it("a mission of one craft and one emitter is seen whole: the recorded flight", () => {
  const state = missionAt(flown, Infinity);
  const view = viewOf(state);
  expect([view.craftId, view.emitterId]).toEqual([CRAFT, EMITTER]);
  const told = <K extends MissionEvent["kind"]>(kind: K) =>
    flown.flatMap(({ event }) => (event.kind === kind ? [event as EventOf<K>] : []));
  expect(view.bearings.map((b) => b.fact)).toEqual(told("bearing_measured"));
  expect(view.beliefs.map((b) => b.bearings)).toEqual(told("belief_updated").map((b) => b.bearings));
  expect(view.plan?.fact).toEqual(told("plan_chosen").at(-1));
  expect(view).toMatchObject({ phase: "done", ended: { fact: told("mission_ended")[0] }, home: told("mission_started")[0]?.home });
  const phases = told("phase_changed").map((event) => event.after);
  const during = flown.flatMap(({ seq, event }) => (event.kind === "phase_changed" ? [viewOf(missionAt(flown, seq)).phase] : []));
  expect(during).toEqual(phases);
});

it("says in one word what the craft does, else how far the search is", () => {
  const word = (...events: MissionEvent[]) => seen({ kind: "mission_drafted", spec: someSpec() }, ...events).phase;
  expect(word()).toBe("draft");
  expect(word({ kind: "preflight_checked", passed: true, checks: [] })).toBe("ready");
  expect(word({ kind: "preflight_checked", passed: false, checks: [] })).toBe("draft");
  expect(word(started())).toBe("searching");
  expect(word(started(), phase("measuring"))).toBe("measuring");
  expect(word(started(), phase("measuring"), phase("ground"))).toBe("ground");
  for (const outcome of ["aborted", "failed"] as const) expect(word(started(), phase("returning"), ended(outcome))).toBe(outcome);
  for (const outcome of ["localized", "not_localized"] as const) expect(word(started(), phase("ground"), ended(outcome))).toBe("done");
});

it("says of an ended mission whose craft was held, or taken over, that it stands still in the air", () => {
  const aborted = [started(), phase("returning"), ended("aborted")];
  for (const still of ["hold", "manual"] as const) expect(seen(...aborted, phase(still)).phase).toBe(still);
  for (const on of ["returning", "landing", "ground"] as const) expect(seen(...aborted, phase("hold"), phase(on)).phase).toBe("aborted");
});

it("a mission flies or is over, never both", () => {
  for (const p of ["draft", "ready", "searching", "ground", "hold", "manual", "measuring", "done", "aborted", "failed"] as const) {
    expect(inFlight(p) && isOver(p)).toBe(false);
  }
  expect(inFlight("hold")).toBe(true);
  expect(inFlight("ready")).toBe(false);
  expect(inFlight("ground")).toBe(false);
});
