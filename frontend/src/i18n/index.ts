// All words of the page come through here. English is the reference; a missing translation does not compile.
import { batch, signal } from "@preact/signals";
import { type Language, locale } from "../units/locale";
import { en, type MessageKey } from "./en";
import { type ReasonTable, sayReasonsIn } from "./reasons";

export { type Language, locale } from "../units/locale";
export type { MessageKey } from "./en";
export { personName, reasonRemedy, reasonText } from "./reasons";
export type Parameters = Record<string, string | number>;

const table = signal<Record<MessageKey, string>>(en);

interface Tables {
  words: Record<MessageKey, string>;
  reasons: ReasonTable;
}

/** The safety bar waits for none of it: it begins in English, and the sentences of reasons come later. */
const loaders: Record<Language, () => Promise<Tables>> = {
  en: async () => ({ words: en, reasons: (await import("./reasons.en")).reasonsEn }),
  de: async () => {
    const [{ de }, { reasonsDe }] = await Promise.all([import("./de"), import("./reasons.de")]);
    return { words: de, reasons: reasonsDe };
  },
};

let wanted: Language | null = null;

/** Rejects when the words cannot be loaded: the page stays in the language it has. The last one asked for wins. */
export async function setLanguage(language: Language): Promise<void> {
  wanted = language;
  const { words, reasons } = await loaders[language]();
  if (wanted !== language) return;
  batch(() => {
    table.value = words;
    locale.value = language;
    sayReasonsIn(reasons);
  });
  document.documentElement.lang = language;
}

export function t(key: MessageKey, parameters: Parameters = {}): string {
  return table.value[key].replace(/\{(\w+)\}/g, (whole, name: string) => String(parameters[name] ?? whole));
}
