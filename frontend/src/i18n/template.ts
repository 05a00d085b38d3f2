// The template language of the reasons' sentences. planner/reason.py has its grammar and writes the same English.
import { type CoordinateFormat, formatPlace } from "../units/coordinates";
import type { Language } from "../units/locale";
import { formatArea, formatDuration, formatLength, formatSpeed, type UnitSystem } from "../units/quantities";

/** What is so, and how to mend it where something can be done. */
export type Words = readonly [text: string, remedy?: string];

/** A reason as it came over the wire: a code and values in SI units. */
export type Coded = { readonly code: string };

export interface Shown {
  language: Language;
  units: UnitSystem;
  coordinates: CoordinateFormat;
  wordsOf: (reason: Coded) => Words;
}

type Values = Readonly<Record<string, unknown>>;

const PLACEHOLDER = /\{(\w+)(?:(!remedy)|@(\w+)|:(\d)|\|([^|{}]*)\|([^|{}]*)|\?([^{}]*))?\}/g;

export const textIn = (shown: Shown, reason: Coded): string => fill(shown.wordsOf(reason)[0], reason, shown);

export const remedyIn = (shown: Shown, reason: Coded): string => fill(shown.wordsOf(reason)[1] ?? "", reason, shown);

function fill(template: string, reason: Coded, shown: Shown): string {
  const values = reason as unknown as Values;
  return template.replace(PLACEHOLDER, (_, name: string, remedy?, lon?, decimals?, one?, many?, choice?: string) => {
    const value = values[name];
    if (remedy !== undefined) return several(value, (because) => remedyIn(shown, because as Coded), " ");
    if (lon !== undefined) return formatPlace({ lat: value as number, lon: values[lon] as number }, shown.coordinates);
    if (one !== undefined) return `${value} ${value === 1 ? one : many}`;
    if (choice !== undefined) return several(value, (key) => chosen(choice, key), ", ");
    return put(name, value, decimals === undefined ? null : Number(decimals), shown);
  });
}

const several = (value: unknown, said: (one: unknown) => string, between: string): string =>
  Array.isArray(value) ? value.map(said).join(between) : said(value);

const isReason = (value: unknown): value is Coded => typeof value === "object" && value !== null && "code" in value;

/** The words for a value; `*` stands for any other. A choice without either is found by the test of all reasons. */
function chosen(choice: string, value: unknown): string {
  const words = new Map(choice.split("|").map((option) => option.split(/=(.*)/s, 2) as [string, string]));
  return words.get(value === null ? "none" : String(value)) ?? words.get("*") ?? String(value);
}

/** Who acts while nobody signs in has a name that is no person's. */
export const personNameIn = (language: Language, by: string): string => (by === "operator" && language === "de" ? "Bediener" : by);

function put(name: string, value: unknown, decimals: number | null, shown: Shown): string {
  if (Array.isArray(value)) return several(value, (one) => put(name, one, decimals, shown), value.some(isReason) ? " " : ", ");
  if (isReason(value)) return textIn(shown, value);
  if (name === "by") return personNameIn(shown.language, String(value));
  if (typeof value !== "number") return String(value);
  const form = FORMS.find(([suffix]) => name.endsWith(suffix))?.[1] ?? plain;
  return form(value, decimals, shown);
}

type Form = (value: number, decimals: number | null, shown: Shown) => string;

/** Halves go to the even neighbour, as in Python: both write the same. Making a formatter costs more than using it. */
const formatters = new Map<string, Intl.NumberFormat>();

function digits(value: number, count: number, { language }: Shown): string {
  const key = `${language}${count}`;
  let formatter = formatters.get(key);
  if (!formatter) {
    formatter = new Intl.NumberFormat(language, {
      minimumFractionDigits: count,
      maximumFractionDigits: count,
      useGrouping: false,
      roundingMode: "halfEven",
    });
    formatters.set(key, formatter);
  }
  return formatter.format(value);
}

const plain: Form = (value, decimals, shown) => {
  if (decimals !== null || Number.isInteger(value)) return digits(value, decimals ?? 0, shown);
  const short = String(Number(value.toPrecision(6)));
  return shown.language === "de" ? short.replace(".", ",") : short;
};

const unit =
  (symbol: string, usual: number, scale = 1): Form =>
  (value, decimals, shown) =>
    `${digits(value / scale, decimals ?? usual, shown)} ${symbol}`;

const degrees = (per: string): Form => {
  const forms = { en: unit(`degrees${per}`, 0), de: unit(`Grad${per}`, 0) };
  return (value, decimals, shown) => forms[shown.language](value, decimals, shown);
};

const larger =
  (from: number, small: Form, large: Form): Form =>
  (value, decimals, shown) =>
    (Math.abs(value) >= from ? large : small)(value, decimals, shown);

/** `coarse` has its own decimals, whatever is asked for. */
const grown =
  (from: number, fine: Form, coarse: Form): Form =>
  (value, decimals, shown) =>
    Math.abs(value) >= from ? coarse(value, null, shown) : fine(value, decimals, shown);

const imperial =
  (metric: Form, format: (value: number, units: UnitSystem) => string): Form =>
  (value, decimals, shown) =>
    shown.units === "imperial" ? format(value, "imperial") : metric(value, decimals, shown);

const seconds = unit("s", 0);
const minutes = unit("min", 0, 60);

/** How a value is written, by the end of its name; the first that fits. */
const FORMS: readonly (readonly [string, Form])[] = [
  ["_deg_s", degrees("/s")],
  ["_m_s", imperial(unit("m/s", 1), formatSpeed)],
  ["_m2", imperial(grown(1e5, unit("m²", 0), unit("km²", 2, 1e6)), formatArea)],
  ["_m", imperial(grown(1e3, unit("m", 0), unit("km", 1, 1e3)), formatLength)],
  ["_time_s", (value, _decimals, shown) => formatDuration(Number(digits(value, 0, { ...shown, language: "en" })))],
  ["_s", (value, decimals, shown) => (decimals === null ? grown(300, seconds, minutes) : seconds)(value, decimals, shown)],
  ["_deg", degrees("")],
  ["_percent", unit("%", 0)],
  ["_hz", larger(1e6, unit("kHz", 1, 1e3), unit("MHz", 4, 1e6))],
  ["_db", unit("dB", 1)],
  ["_bytes", larger(2 ** 20, unit("kB", 0, 2 ** 10), unit("MB", 0, 2 ** 20))],
];
