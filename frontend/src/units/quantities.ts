// Lengths, areas, speeds and times for people. Input is always SI.

import { locale } from "./locale";

export type UnitSystem = "metric" | "imperial";

const FOOT = 0.3048;
/** Making a formatter costs more than using it a thousand times. */
const formatters = new Map<string, Intl.NumberFormat>();

function grouped(value: number, digits = 0): string {
  const key = `${locale.value}${digits}`;
  let formatter = formatters.get(key);
  if (!formatter) {
    formatter = new Intl.NumberFormat(locale.value, {
      minimumFractionDigits: digits,
      maximumFractionDigits: digits,
      signDisplay: "negative",
    });
    formatters.set(key, formatter);
  }
  return formatter.format(value);
}

export const formatNumber = grouped;

/** A decimal for small values that have any: a goal of 50 m was set, not measured. */
const digitsFor = (value: number) => (Math.abs(value) < 100 && !Number.isInteger(value) ? 1 : 0);

export function formatLength(metres: number, units: UnitSystem): string {
  if (units === "imperial") {
    const feet = metres / FOOT;
    return Math.abs(feet) >= 5280 ? `${grouped(feet / 5280, 2)} mi` : `${grouped(feet, digitsFor(feet))} ft`;
  }
  return Math.abs(metres) >= 2000 ? `${grouped(metres / 1000, 2)} km` : `${grouped(metres, digitsFor(metres))} m`;
}

export function formatArea(squareMetres: number, units: UnitSystem): string {
  if (units === "imperial") {
    const acres = squareMetres / 4046.8564224;
    return acres >= 0.5 ? `${grouped(acres, 2)} acres` : `${grouped(squareMetres / FOOT ** 2)} ft²`;
  }
  return squareMetres >= 100_000 ? `${grouped(squareMetres / 1e6, 2)} km²` : `${grouped(squareMetres)} m²`;
}

export function formatSpeed(metresPerSecond: number, units: UnitSystem): string {
  return units === "imperial" ? `${grouped(metresPerSecond / 0.44704, 1)} mph` : `${grouped(metresPerSecond, 1)} m/s`;
}

/** 130 -> "2:10", 3725 -> "1:02:05". */
export function formatDuration(seconds: number): string {
  const whole = Math.max(0, Math.round(seconds));
  const s = String(whole % 60).padStart(2, "0");
  const m = Math.floor(whole / 60) % 60;
  const h = Math.floor(whole / 3600);
  return h > 0 ? `${h}:${String(m).padStart(2, "0")}:${s}` : `${m}:${s}`;
}

/** Compass degrees as three digits: 7.4 -> "007°". */
export const formatBearing = (degrees: number): string => `${String(Math.round(((degrees % 360) + 360) % 360) % 360).padStart(3, "0")}°`;

/** How old a value is, short: "4 s", "3 min". */
export const formatAge = (seconds: number): string => (seconds < 100 ? `${Math.round(seconds)} s` : `${Math.round(seconds / 60)} min`);

export const formatClock = (iso: string): string => new Date(iso).toISOString().slice(11, 19);

/** An angle with its sign, whole degrees unless digits are asked for: 6.4 -> "+6", -0.2 -> "0". */
export const signedDegrees = (degrees: number, digits = 0): string => {
  const rounded = Number(degrees.toFixed(digits));
  const size = formatNumber(Math.abs(rounded), digits);
  return rounded > 0 ? `+${size}` : rounded < 0 ? `−${size}` : size;
};
