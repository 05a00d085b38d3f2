// What the server says in words (reasons, checks, alerts), in the page's language. Its English sentences are the codes:
// told.json has one for each, with {} where the server puts a value; a sentence that is not there is shown as it came.
import { signal } from "@preact/signals";
import { formatArea, formatLength, formatSpeed, type UnitSystem } from "../units/quantities";

type Sentence = { pattern: RegExp; german: string; opens: boolean; literal: number };

const sentences = signal<readonly Sentence[] | null>(null);

const escaped = (text: string) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

/** What is told of something that has a name, "receiver: {}": the rest may itself begin with a value and a colon. */
const OPENS = /^[^{}]+: /;

/** In the order in which they are tried: those that open with a name, then those with the most words. */
export function sentencesOf(table: Record<string, string>): Sentence[] {
  return Object.entries(table)
    .map(([english, german]) => {
      const parts = english.split("{}");
      const pattern = new RegExp(`^${parts.map(escaped).join("(.+?)")}$`, "s");
      return { pattern, german, opens: OPENS.test(english), literal: parts.join("").length };
    })
    .toSorted((a, b) => Number(b.opens) - Number(a.opens) || b.literal - a.literal);
}

/** Called by the language table: null for English. */
export function tellIn(table: Record<string, string> | null): void {
  sentences.value = table === null ? null : sentencesOf(table);
}

/** "...reason (not yet: this; not yet: that)", as the end of a mission is told. */
const WITH_REASONS = /^(.+?) \((not yet: .+)\)$/s;

/** A sentence that the server began with a capital and ended with a dot, as it stands in the table; else null. */
const bare = (text: string) => (/^[^a-z].*[^.]\.$/s.test(text) ? text[0]!.toLowerCase() + text.slice(1, -1) : null);

const sentence = (text: string) => `${text[0]!.toUpperCase()}${text.slice(1)}${text.endsWith("?") ? "" : "."}`;

export function translated(text: string, known: readonly Sentence[]): string {
  const more = WITH_REASONS.exec(text);
  if (more) return `${translated(more[1]!, known)} (${more[2]!.split("; ").map((part) => translated(part, known)).join("; ")})`;
  const inner = bare(text);
  if (inner !== null && WITH_REASONS.test(inner)) return sentence(translated(inner, known));
  const put = (german: string, found: RegExpExecArray) =>
    german.replace(/\{(\d)\}/g, (_, place: string) => value(found[Number(place)]!, known));
  for (const { pattern, german } of known) {
    const within = inner === null ? null : pattern.exec(inner); // first, or the last value of a vague one takes the dot
    if (within) return sentence(put(german, within));
    const found = pattern.exec(text);
    if (found) return put(german, found);
  }
  return text;
}

const value = (text: string, known: readonly Sentence[]): string =>
  /^-?\d+\.\d+$/.test(text) ? text.replace(".", ",") : translated(text, known);

const capital = (text: string) => (/^[a-z]+([ :]|$)/.test(text) ? text[0]!.toUpperCase() + text.slice(1) : text);

const units = signal<UnitSystem>("metric");

export function tellInUnits(system: UnitSystem): void {
  units.value = system;
}

const QUANTITY = /(-?\d+(?:[.,]\d+)?) (m2|m²|m\/s|m)(?![\w²/])/g;

/** The server's SI values as the operator reads them; metric lengths and speeds already are as exact as they should be. */
function inUnits(text: string, system: UnitSystem): string {
  return text.replace(QUANTITY, (asSent, digits: string, unit: string) => {
    const value = Number(digits.replace(",", "."));
    if (unit === "m2" || unit === "m²") return formatArea(value, system);
    if (system === "metric") return asSent;
    return unit === "m" ? formatLength(value, system) : formatSpeed(value, system);
  });
}

export const told = (text: string): string =>
  inUnits(sentences.value === null ? text : translated(text, sentences.value), units.value);

/** The name of a check or a rule, as a heading. */
export const toldName = (text: string): string => capital(told(text).replace(/(?<=[a-z])_(?=[a-z])/g, " "));

/** A reason why not yet, without the words that stand above all of them. */
export const toldReason = (text: string): string => told(text).replace(/^(not yet|noch nicht): /, "");
