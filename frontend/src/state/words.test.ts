// @vitest-environment happy-dom
import { afterEach, describe, expect, it } from "vitest";
import { reasonText, setLanguage, t } from "../i18n";
import type { EventOf, MissionEvent } from "../wire";
import { CRAFT, ended, flown, leadingTo, phase, record, someReason } from "../wire/examples";
import { NOBODY } from "./craft";
import { eventWords, isMain } from "./eventWords";
import { missionAt } from "./mission";
import { viewOf } from "./view";
import { checkName, stateWords } from "./words";

const words = (event: MissionEvent) => eventWords(record(event)[0]!, "metric");
const doing = (...events: MissionEvent[]) => stateWords(viewOf(missionAt(record(...events), Infinity)), null);

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
    expect(words(changed({ who: "failsafe", taken_by: "mode", mode: "RTL" }))).toBe(t("control.failsafe", { mode: "RTL" }));
    expect(words(changed({ who: "ours" }, "Ada"))).toBe(t("event.control_taken_back", { by: "Ada" }));
    expect([pilot, changed({ who: "ours" }, "Ada"), changed({ who: "ours" })].map(isMain)).toEqual([true, true, false]);
  });

  it("names the checks that failed and the command that was refused", () => {
    const check = { name: "ready_to_arm", ok: false, reason: someReason, blocking: true } as const;
    expect(words({ kind: "preflight_checked", passed: false, checks: [check] })).toContain(checkName("ready_to_arm"));
    const refused: MissionEvent = { kind: "command_refused", command_id: "c", command: "set_automatic", by: "Ada", reason: someReason };
    expect(words(refused)).toBe(t("event.command_refused", { command: t("command.set_automatic"), reason: reasonText(someReason) }));
    expect(words({ ...refused, command: "of_later" })).toContain("of_later");
  });
});

describe("in each language", () => {
  afterEach(() => setLanguage("en"));

  it.each(["en", "de"] as const)("the recorded flight has words for every event: %s", async (language) => {
    await setLanguage(language);
    for (const recorded of flown) expect(eventWords(recorded, "metric")).not.toMatch(/\{|undefined|\[object/);
  });
});

it("says what the mission does in every phase, and why it ended", () => {
  expect(doing(...leadingTo("searching"))).toBe(t("state.searching"));
  expect(doing(...leadingTo("hold"))).toBe(t("state.hold", { reason: reasonText(someReason) }));
  expect(doing(...leadingTo("done"))).toBe(t("state.done", { reason: reasonText(someReason) }));
  expect(doing(...leadingTo("planning"))).toBe(t("state.planning", { number: 1 }));
});
