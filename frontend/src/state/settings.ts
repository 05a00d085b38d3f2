// What the operator prefers, kept in this browser.
import { effect, signal } from "@preact/signals";
import { type Language, setLanguage } from "../i18n";
import type { CoordinateFormat } from "../units/coordinates";
import type { UnitSystem } from "../units/quantities";
import { coordinateFormat, unitSystem } from "../units/shown";
import { keep, kept } from "./kept";

export interface Settings {
  theme: "outdoor" | "indoor";
  scale: number;
  units: UnitSystem;
  coordinates: CoordinateFormat;
  language: Language;
  tones: boolean;
  speech: boolean;
  lite: boolean;
  tourSeen: boolean;
}

const KEY = "crossfix.settings";

export const defaultSettings: Settings = {
  theme: "outdoor",
  scale: 1,
  units: "metric",
  coordinates: "dd",
  language: navigator.language.startsWith("de") ? "de" : "en",
  tones: true,
  speech: false,
  lite: false,
  tourSeen: false,
};

/** Unreadable or foreign entries are ignored: the defaults hold for them. */
export function readSettings(stored: string | null): Settings {
  if (!stored) return defaultSettings;
  let parsed: unknown;
  try {
    parsed = JSON.parse(stored);
  } catch {
    return defaultSettings;
  }
  if (typeof parsed !== "object" || parsed === null) return defaultSettings;
  const given = parsed as Record<string, unknown>;
  const known = Object.entries(defaultSettings).map(([key, value]) => [key, typeof given[key] === typeof value ? given[key] : value]);
  const read = Object.fromEntries(known) as Settings;
  return { ...read, theme: read.theme === "indoor" ? "indoor" : "outdoor" };
}

export const settings = signal<Settings>(readSettings(kept(KEY)));

export function change<K extends keyof Settings>(key: K, value: Settings[K]): void {
  settings.value = { ...settings.value, [key]: value };
  keep(KEY, settings.value);
}

// chosen in another tab; what was chosen here may not have been stored
addEventListener("storage", ({ key, oldValue, newValue }) => {
  if (key !== KEY) return;
  const [was, is] = [readSettings(oldValue), readSettings(newValue)];
  const chosen = Object.entries(is).filter(([name, value]) => value !== was[name as keyof Settings]);
  settings.value = { ...settings.peek(), ...Object.fromEntries(chosen) };
});

/** onLanguageLost: its words could not be loaded; a language chosen before stays chosen. */
export function applySettings(onLanguageLost: (wanted: Language) => void): void {
  let spoken: Language | null = null;
  const speak = async (wanted: Language) => {
    try {
      await setLanguage(wanted);
      spoken = wanted;
    } catch {
      if (spoken !== null && settings.peek().language === wanted) change("language", spoken);
      onLanguageLost(wanted);
    }
  };
  effect(() => {
    document.documentElement.dataset.theme = settings.value.theme;
    document.documentElement.style.fontSize = `${settings.value.scale * 100}%`;
  });
  effect(() => {
    void speak(settings.value.language);
    unitSystem.value = settings.value.units;
    coordinateFormat.value = settings.value.coordinates;
  });
}
