// @vitest-environment happy-dom
import { afterEach, beforeEach, describe, expect, it } from "vitest";
import { reasonText, setLanguage, t } from "../i18n";
import { formatBearing, formatNumber } from "../units/quantities";
import type { EventOf, MissionEvent } from "../wire";
import {
  CRAFT,
  EMITTER,
  ended,
  flown,
  leadingTo,
  NOBODY,
  phase,
  record,
  someBearing,
  someReason,
  someSpec,
  started,
} from "../wire/examples";
import { isMain } from "./eventWeight";
import { eventWords } from "./eventWords";
import { missionAt } from "./mission";
import { viewOf } from "./view";
import { checkName, noseWords, stateWords } from "./words";

const words = (event: MissionEvent) => eventWords(record(event)[0]!, "metric", []);
const seen = (...events: MissionEvent[]) => viewOf(missionAt(record(...events), Infinity));
const doing = (...events: MissionEvent[]) => stateWords(seen(...events), null);

const held = (by: string | null, reason: EventOf<"hold_ordered">["reason"]): MissionEvent => ({
  kind: "hold_ordered",
  craft_id: CRAFT,
  by,
  reason,
});

describe("an event in words", () => {
  it("says the reason's own sentence", () => {
    expect(words(phase("hold"))).toBe(`${t("phase.hold")}: ${reasonText(someReason)}`);
    expect(words(ended("failed"))).toContain(reasonText(someReason));
  });

  it("names who ordered it, and the mission when it did by itself, with its reason", () => {
    expect(words(held("Ada", null))).toBe(t("event.hold_ordered", { by: "Ada" }));
    expect(words(held(null, someReason))).toBe(`${t("event.hold_ordered", { by: t("by.mission") })}: ${reasonText(someReason)}`);
  });

  it("tells who flies, and who took control back", () => {
    const changed = (changes: Partial<typeof NOBODY>, by: string | null = null): EventOf<"authority_changed"> => ({
      kind: "authority_changed",
      craft_id: CRAFT,
      authority: { ...NOBODY, ...changes },
      by,
    });
    const pilot = changed({ who: "pilot", taken_by: "mode", mode: "POSCTL" });
    expect(words(pilot)).toBe(t("control.pilot", { mode: "POSCTL" }));
    expect(words(changed({ who: "pilot", taken_by: "sticks" }))).toBe(t("control.pilot", { mode: t("control.sticks") }));
    expect(words(changed({ who: "pilot", taken_by: "mode", mode: "RTL", perhaps_failsafe: true }))).toBe(
      t("control.perhapsFailsafe", { mode: "RTL" }),
    );
    expect(words(changed({ who: "pilot", taken_by: "mode", mode: "LAND", given_back: true, perhaps_failsafe: true }))).toBe(
      t("control.perhapsGivenBack"),
    );
    expect(words(changed({ who: "failsafe", taken_by: "mode", mode: "RTL" }))).toBe(t("control.failsafe", { mode: "RTL" }));
    expect(words(changed({ who: "ours" }, "Ada"))).toBe(t("event.control_taken_back", { by: "Ada" }));
    expect([pilot, changed({ who: "ours" }, "Ada"), changed({ who: "ours" })].map(isMain)).toEqual([true, true, false]);
  });

  it("tells no quality of an imported bearing that no sweep stands behind", () => {
    const told = someBearing({ source: { kind: "import", recording_id: "r" }, quality: 1, remarks: [] });
    const of = (quality: string) =>
      t("event.bearing_measured", {
        ...{ bearing: formatBearing(told.bearing_deg), sigma: formatNumber(told.sigma_deg, 1) },
        ...{ number: told.place_number, quality },
      });
    expect(words(told)).toBe(of("1.00"));
    expect(words({ ...told, sweep_id: null })).toBe(of("–"));
  });

  it("names the checks that failed and the command that was refused", () => {
    const check = { name: "ready_to_arm", ok: false, reason: someReason, blocking: true } as const;
    expect(words({ kind: "preflight_checked", passed: false, checks: [check] })).toContain(checkName("ready_to_arm"));
    const refused = {
      ...{ kind: "command_refused", command_id: "c", command: "set_automatic", by: "Ada", reason: someReason },
      ...{ order: null, author: null },
    } satisfies MissionEvent;
    expect(words(refused)).toBe(t("event.command_refused", { command: t("command.set_automatic"), reason: reasonText(someReason) }));
    expect(words({ ...refused, command: "of_later" })).toContain("of_later");
  });
});

describe("a flight to a place", () => {
  const flying = (sensor: Partial<ReturnType<typeof someSpec>["sensor"]>) => {
    const spec = someSpec();
    const drafted = { kind: "mission_drafted", spec: { ...spec, sensor: { ...spec.sensor, ...sensor } } } as const;
    return noseWords(seen(drafted, started(), phase("flying")));
  };
  const joint = { bearing_errors: "joint" } as const;

  it("says that the nose swings, where it does", () => {
    const swings = t("state.noseSwings");
    expect(flying({ ...joint, listen_on_the_way: true, swing_on_the_way: true })).toBe(swings);
    expect(flying({ ...joint, listen_on_the_way: false, swing_on_the_way: true })).toBeNull();
    expect(flying({ ...joint, listen_on_the_way: true, swing_on_the_way: false })).toBeNull();
    expect(flying({ bearing_errors: "independent", listen_on_the_way: true, swing_on_the_way: true })).toBeNull();
  });
});

describe("in each language", () => {
  afterEach(() => setLanguage("en"));

  it.each(["en", "de"] as const)("the recorded flight has words for every event: %s", async (language) => {
    await setLanguage(language);
    for (const recorded of flown) expect(eventWords(recorded, "metric", [])).not.toMatch(/\{|undefined|\[object/);
  });
});

it("names the emitter that an event is about where the mission looks for several", () => {
  const [first] = someSpec().emitters;
  const several = [first!, { ...first!, emitter_id: "e2" }, { ...first!, emitter_id: "e3", label: "collar" }];
  const said = (emitter_id: string, emitters = several) => eventWords(record(someBearing({ emitter_id }))[0]!, "metric", emitters);
  expect(said("e2")).toBe(`${first!.label} 2: ${said("e2", [])}`);
  expect(said("e3")).toBe(`collar: ${said("e3", [])}`);
  expect(said(EMITTER, [first!])).toBe(said(EMITTER, []));
  expect(eventWords(record(phase("hold"))[0]!, "metric", several)).toBe(words(phase("hold")));
});

it("says no longer of a link that is back that it is lost", () => {
  const reason = { code: "no_console", stage: "hold" } as const;
  const lost: MissionEvent = { kind: "link_lost", craft_id: CRAFT, link: "console", reason };
  const back: MissionEvent = { kind: "link_restored", craft_id: CRAFT, link: "console", outage_s: 40 };
  expect(doing(started(), lost, phase("hold", reason))).toBe(t("state.hold", { reason: reasonText(reason) }));
  expect(doing(started(), lost, phase("hold", reason), back)).toBe(t("state.hold.back", { link: t("link.console") }));
});

it("says after an abort that was held why it holds, not why it ended", () => {
  const because = { code: "ordered", order: "hold", by: "Ada" } as const;
  expect(doing(...leadingTo("aborted"), phase("hold", because))).toBe(t("state.hold", { reason: reasonText(because) }));
});

it("says neither that it holds while its failsafe flies, nor that it flies once it stands", () => {
  const reason = { code: "failsafe_flies", because: "battery" } as const;
  const landed: MissionEvent = {
    ...{ kind: "alert_raised", alert_id: "a", topic: "ground", level: "warning", craft_id: CRAFT, emitter_id: null },
    reason: { code: "landed", during: "hold" },
  };
  const cleared: MissionEvent = { kind: "alert_cleared", alert_id: "a" };
  expect(doing(started(), phase("hold", reason))).toBe(reasonText(reason));
  expect(doing(started(), phase("hold", reason), landed)).toBe(t("state.ground"));
  expect(doing(started(), phase("hold", someReason), landed)).toBe(t("state.ground"));
  expect(doing(started(), phase("hold", someReason), landed, cleared)).toBe(t("state.hold", { reason: reasonText(someReason) }));
  expect(doing(started(), phase("hold", someReason), { ...landed, craft_id: "another" })).not.toBe(t("state.ground"));
});

describe.each(["en", "de"] as const)("a failsafe in hold, in words: %s", (language) => {
  const flies = { code: "failsafe_flies", because: "position" } as const;
  const ordered = { code: "ordered", order: "hold", by: "Ada" } as const;
  const authority = (changes: Partial<typeof NOBODY>): MissionEvent => ({
    ...{ kind: "authority_changed", craft_id: CRAFT, by: null },
    authority: { ...NOBODY, ...changes },
  });
  const alert = (alert_id: string, reason: EventOf<"alert_raised">["reason"]): MissionEvent => ({
    ...{ kind: "alert_raised", alert_id, topic: "vehicle", level: "caution", craft_id: CRAFT, emitter_id: null },
    reason,
  });
  const taken = authority({ who: "failsafe", taken_by: "mode", mode: "LAND" });
  const began = [taken, alert("a", flies)];
  const over: MissionEvent = { kind: "alert_cleared", alert_id: "a" };

  beforeEach(() => setLanguage(language));
  afterEach(() => setLanguage("en"));

  it("that began in a hold that was ordered", () => {
    expect(doing(started(), phase("hold", ordered), ...began)).toBe(reasonText(flies));
    expect(doing(started(), phase("hold", ordered), taken)).toBe(t("control.failsafe", { mode: "LAND" }));
  });

  it("that an operator ended", () => {
    const ours = [over, authority({ who: "ours" })];
    const holds = t("state.hold", { reason: reasonText(ordered) });
    expect(doing(started(), phase("hold", flies), ...began, ...ours, held("Ada", null))).toBe(holds);
    const resumed: MissionEvent = { kind: "resume_ordered", craft_id: CRAFT, by: "Ada" };
    expect(doing(started(), phase("hold", flies), ...began, resumed, ...ours)).not.toContain(reasonText(flies));
  });

  it("that stopped by itself, and that landed", () => {
    const stopped = { code: "failsafe_stopped", mode: "HOLD" } as const;
    const waits = authority({ who: "failsafe", taken_by: "mode", mode: "HOLD", given_back: true });
    const holds = t("state.hold", { reason: reasonText(stopped) });
    expect(doing(started(), phase("hold", flies), ...began, waits, over, alert("b", stopped))).toBe(holds);
    const down = authority({ who: "nobody", taken_by: "mode", failsafe_landed: true });
    expect(doing(started(), phase("hold", flies), ...began, down)).toBe(t("state.ground"));
  });

  it("that flies a vehicle which stood on the ground before, or has landed it and keeps its motors armed", () => {
    const stood: MissionEvent = { ...(alert("g", { code: "landed", during: "hold" }) as EventOf<"alert_raised">), topic: "ground" };
    expect(doing(started(), phase("hold", ordered), stood, ...began)).toBe(reasonText(flies));
    for (const reason of [ordered, flies]) expect(doing(started(), phase("hold", reason), ...began, over, stood)).toBe(t("state.ground"));
  });
});

it("says what the mission does in every phase, and why it ended", () => {
  expect(doing(...leadingTo("searching"))).toBe(t("state.searching"));
  expect(doing(...leadingTo("hold"))).toBe(t("state.hold", { reason: reasonText(someReason) }));
  expect(doing(...leadingTo("done"))).toBe(t("state.done", { reason: reasonText(someReason) }));
  expect(doing(...leadingTo("planning"))).toBe(t("state.planning", { number: 1 }));
});
