// Why something is so, or cannot be, in the page's language and the operator's units.
import { signal } from "@preact/signals";
import { locale } from "../units/locale";
import { coordinateFormat, unitSystem } from "../units/shown";
import type { Reason, ReasonCode } from "../wire";
import { type Coded, personNameIn, remedyIn, type Shown, textIn, type Words } from "./template";

/** A sentence and its remedy for every reason: a missing one does not compile. */
export type ReasonTable = Record<ReasonCode, Words>;

/** Not part of what the safety bar waits for; null until it has come. */
const table = signal<ReasonTable | null>(null);

export function sayReasonsIn(words: ReasonTable): void {
  table.value = words;
}

/** A recording of a later server may hold a reason that this page does not know: its code is shown. */
const wordsOf = ({ code }: Coded): Words => {
  if (table.value === null) return ["…"];
  return table.value[code as ReasonCode] ?? [code];
};

const shown = (): Shown => ({
  language: locale.value,
  units: unitSystem.value,
  coordinates: coordinateFormat.value,
  wordsOf,
});

/** What is so: whole sentences. */
export const reasonText = (reason: Reason): string => textIn(shown(), reason);

/** How to mend it: whole sentences, or nothing when there is nothing to do. */
export const reasonRemedy = (reason: Reason): string => remedyIn(shown(), reason);

export const personName = (by: string): string => personNameIn(locale.value, by);
