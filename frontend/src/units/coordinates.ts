// Latitude and longitude in the four notations of the field.

import { signal } from "@preact/signals";
import type { Place } from "../wire";

export type CoordinateFormat = "dd" | "dms" | "utm" | "mgrs";

/** UTM and MGRS weigh an eighth of what the safety bar may: read once somebody wants them, decimal degrees until then. */
const grid = signal<typeof import("./gridNotation") | null>(null);

export async function readGridNotation(): Promise<void> {
  grid.value ??= await import("./gridNotation");
}

function dms(value: number, positive: string, negative: string, degreeDigits: number): string {
  const tenths = Math.round(Math.abs(value) * 36_000);
  const seconds = (tenths % 600) / 10;
  const minutes = Math.floor(tenths / 600) % 60;
  const degrees = Math.floor(tenths / 36_000);
  const hemisphere = value < 0 ? negative : positive;
  return `${String(degrees).padStart(degreeDigits, "0")}°${String(minutes).padStart(2, "0")}′${seconds.toFixed(1).padStart(4, "0")}″ ${hemisphere}`;
}

/** Outside 80 S .. 84 N neither UTM nor MGRS is defined: decimal degrees are given instead. */
export function formatPlace({ lat, lon }: Place, format: CoordinateFormat): string {
  const inUtm = lat >= -80 && lat <= 84;
  if (format === "dms") return `${dms(lat, "N", "S", 2)} ${dms(lon, "E", "W", 3)}`;
  if ((format === "utm" || format === "mgrs") && inUtm) {
    if (grid.value) return grid.value.formatGrid({ lat, lon }, format);
    readGridNotation().catch(() => undefined); // asked for again with the next place
  }
  return `${Math.abs(lat).toFixed(5)} ${lat < 0 ? "S" : "N"} ${Math.abs(lon).toFixed(5)} ${lon < 0 ? "W" : "E"}`;
}
