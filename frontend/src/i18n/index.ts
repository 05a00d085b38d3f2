// All words of the page come through here. English is the reference; a missing translation does not compile.
import { signal } from "@preact/signals";
import { en, type MessageKey } from "./en";
import { locale, type Language } from "./locale";
import { tellIn } from "./told";

export type { MessageKey } from "./en";
export { locale, type Language } from "./locale";
export { told, tellInUnits, toldName, toldReason } from "./told";
export type Parameters = Record<string, string | number>;

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
