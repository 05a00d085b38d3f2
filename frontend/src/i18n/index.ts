// All words of the page come through here. English is the reference; a missing translation does not compile.
import { batch, signal } from "@preact/signals";
import { type Language, locale } from "../units/locale";
import { en } from "./en";
import type { pagesEn } from "./pages.en";
import { type ReasonTable, sayReasonsIn } from "./reasons";

export { type Language, locale } from "../units/locale";
export type MessageKey = keyof typeof en | keyof typeof pagesEn;
export { personName, reasonRemedy, reasonText } from "./reasons";
export type Parameters = Record<string, string | number>;

/** Of the pages' words none at first. */
const table = signal<Partial<Record<MessageKey, string>>>(en);

interface Tables {
  words: Record<MessageKey, string>;
  reasons: ReasonTable;
}

/** The safety bar waits for none of it: it begins in English, and the sentences of reasons come later. */
const loaders: Record<Language, () => Promise<Tables>> = {
  en: async () => {
    const [{ pagesEn }, { reasonsEn }] = await Promise.all([import("./pages.en"), import("./reasons.en")]);
    return { words: { ...en, ...pagesEn }, reasons: reasonsEn };
  },
  de: async () => {
    const [{ de }, { reasonsDe }] = await Promise.all([import("./de"), import("./reasons.de")]);
    return { words: de, reasons: reasonsDe };
  },
};

/** Without a language of its own: reasons and numbers stay as they are. */
export function sayWordsIn(words: Record<MessageKey, string>): void {
  table.value = words;
}

let wanted: Language | null = null;

/** Rejects when the words cannot be loaded: the page stays in the language it has. The last one asked for wins. */
export async function setLanguage(language: Language): Promise<void> {
  wanted = language;
  const { words, reasons } = await loaders[language]();
  if (wanted !== language) return;
  batch(() => {
    sayWordsIn(words);
    locale.value = language;
    sayReasonsIn(reasons);
  });
  document.documentElement.lang = language;
}

export function t(key: MessageKey, parameters: Parameters = {}): string {
  return (table.value[key] ?? "").replace(/\{(\w+)\}/g, (whole, name: string) => String(parameters[name] ?? whole));
}
