import { describe, expect, it } from "vitest";
import spoken from "../../../tests/golden/reasons.json?raw";
import type { Reason, ReasonCode } from "../wire";
import type { ReasonTable } from "./reasons";
import { reasonsDe } from "./reasons.de";
import { reasonsEn } from "./reasons.en";
import { type Coded, remedyIn, type Shown, textIn } from "./template";

const EXAMPLES = JSON.parse(spoken) as [Reason, string, string][];
const CODES = Object.keys(reasonsEn) as ReasonCode[];

const shownIn = (language: Shown["language"], table: ReasonTable): Shown => ({
  language,
  units: "metric",
  coordinates: "dd",
  wordsOf: (reason: Coded) => table[reason.code as ReasonCode],
});
const english = shownIn("en", reasonsEn);
const german = shownIn("de", reasonsDe);

const values = (template: string) => [...new Set([...template.matchAll(/[{@](\w+)/g)].map((found) => found[1]!))].toSorted();

/** Of an old journal: it stands as it was written. */
const asWritten = (reason: Reason) => JSON.stringify(reason).includes("told_before");

describe("the reasons", () => {
  it("are the same in English as the server says them", () => {
    for (const [reason, text, remedy] of EXAMPLES) expect([textIn(english, reason), remedyIn(english, reason)]).toEqual([text, remedy]);
  });

  it("all have an example", () => {
    expect(CODES.filter((code) => !EXAMPLES.some(([reason]) => reason.code === code))).toEqual([]);
  });

  it("say the same values in both languages, and a remedy in both or in none", () => {
    for (const code of CODES) {
      const [[text, remedy], [germanText, germanRemedy]] = [reasonsEn[code], reasonsDe[code]];
      expect(values(germanText), code).toEqual(values(text));
      expect(values(germanRemedy ?? ""), code).toEqual(values(remedy ?? ""));
      expect(germanRemedy === undefined, code).toBe(remedy === undefined);
      expect([remedy, germanRemedy], code).not.toContain("");
    }
  });

  it("are whole sentences in German, with words for every value", () => {
    for (const [reason] of EXAMPLES.filter(([reason]) => !asWritten(reason)))
      for (const said of [textIn(german, reason), remedyIn(german, reason)].filter((one) => one !== "")) {
        expect(said, reason.code).toMatch(/^[^a-zäöü].*[.!?]$/s);
        expect(said, reason.code).not.toMatch(/[{}]|undefined|\s\s|\b(true|false)\b/);
      }
  });

  it("choose German words for the values that English has words for", () => {
    const choices = /\{(\w+)\?([^{}]*)\}/g;
    for (const code of CODES) {
      const [text, remedy = ""] = reasonsDe[code];
      for (const [, name, options] of `${text} ${remedy}`.matchAll(choices)) {
        const known = options!.split("|").map((option) => option.split("=")[0]!);
        const sent = EXAMPLES.filter(([reason]) => reason.code === code).flatMap(
          ([reason]) => (reason as unknown as Record<string, unknown>)[name!],
        );
        const unknown = sent.map((value) => (value === null ? "none" : String(value))).filter((key) => !known.includes(key));
        expect(known.includes("*") ? [] : unknown, `${code}.${name}`).toEqual([]);
      }
    }
  });
});
