// All words of the page come through here. English is the reference; a missing translation does not compile.
import { signal } from "@preact/signals";
import { en, type MessageKey } from "./en";
import { tellIn } from "./told";

export type { MessageKey } from "./en";
export { told, tellInUnits, toldName, toldReason } from "./told";
export type Language = "en" | "de";
export type Parameters = Record<string, string | number>;

/** For numbers: which mark groups thousands, which one parts the decimals. */
export const locale = signal<Language>("en");

const table = signal<Record<MessageKey, string>>(en);

export async function setLanguage(language: Language): Promise<void> {
  if (language === "de") {
    const [{ de }, told] = await Promise.all([import("./de"), import("./told.json")]);
    table.value = de;
    tellIn(told.default);
  } else {
    table.value = en;
    tellIn(null);
  }
  locale.value = language;
  document.documentElement.lang = language;
}

export function t(key: MessageKey, parameters: Parameters = {}): string {
  return table.value[key].replace(/\{(\w+)\}/g, (whole, name: string) => String(parameters[name] ?? whole));
}
