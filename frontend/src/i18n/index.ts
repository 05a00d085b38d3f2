// All words of the page come through here. English is the reference; a missing translation does not compile.
import { signal } from "@preact/signals";
import { type Language, locale } from "../units/locale";
import { en, type MessageKey } from "./en";
import { sayReasonsIn } from "./reasons";

export { type Language, locale } from "../units/locale";
export type { MessageKey } from "./en";
export { reasonRemedy, reasonText } from "./reasons";
export type Parameters = Record<string, string | number>;

const table = signal<Record<MessageKey, string>>(en);

/** The sentences of reasons come after the words of the page: the safety bar does not wait for them. */
export async function setLanguage(language: Language): Promise<void> {
  if (language === "de") {
    const [{ de }, { reasonsDe }] = await Promise.all([import("./de"), import("./reasons.de")]);
    show(language, de);
    sayReasonsIn(reasonsDe);
  } else {
    show(language, en);
    sayReasonsIn((await import("./reasons.en")).reasonsEn);
  }
}

function show(language: Language, words: Record<MessageKey, string>): void {
  table.value = words;
  locale.value = language;
  document.documentElement.lang = language;
}

export function t(key: MessageKey, parameters: Parameters = {}): string {
  return table.value[key].replace(/\{(\w+)\}/g, (whole, name: string) => String(parameters[name] ?? whole));
}
