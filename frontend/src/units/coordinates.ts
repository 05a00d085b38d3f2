// Latitude and longitude in the four notations of the field.

import Mgrs, { LatLon as MgrsLatLon } from "geodesy/mgrs.js";
import Utm, { LatLon as UtmLatLon } from "geodesy/utm.js";
import type { Place } from "../wire";

export type CoordinateFormat = "dd" | "dms" | "utm" | "mgrs";

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
  if (format === "utm" && inUtm) {
    const utm = new UtmLatLon(lat, lon).toUtm();
    return `${utm.zone} ${utm.hemisphere} ${utm.easting.toFixed(0)} ${utm.northing.toFixed(0)}`;
  }
  if (format === "mgrs" && inUtm) return new MgrsLatLon(lat, lon).toUtm().toMgrs().toString(10);
  return `${Math.abs(lat).toFixed(5)} ${lat < 0 ? "S" : "N"} ${Math.abs(lon).toFixed(5)} ${lon < 0 ? "W" : "E"}`;
}

function parseDecimal(text: string): Place | null {
  const found = /^\s*([+-]?\d+(?:\.\d+)?)\s*°?\s*([NS])?[\s,;]+([+-]?\d+(?:\.\d+)?)\s*°?\s*([EW])?\s*$/i.exec(text);
  if (!found) return null;
  const lat = Number(found[1]) * (found[2]?.toUpperCase() === "S" ? -1 : 1);
  const lon = Number(found[3]) * (found[4]?.toUpperCase() === "W" ? -1 : 1);
  return { lat, lon };
}

function parseDms(text: string): Place | null {
  const part = String.raw`(\d+)[°d\s]+(\d+)['′m\s]+(\d+(?:\.\d+)?)["″s\s]*`;
  const found = new RegExp(String.raw`^\s*${part}([NS])[\s,]*${part}([EW])\s*$`, "i").exec(text);
  if (!found) return null;
  const angle = (i: number) => Number(found[i]) + Number(found[i + 1]) / 60 + Number(found[i + 2]) / 3600;
  return {
    lat: angle(1) * (found[4]!.toUpperCase() === "S" ? -1 : 1),
    lon: angle(5) * (found[8]!.toUpperCase() === "W" ? -1 : 1),
  };
}

/** UTM and MGRS parsers throw on anything else; null then. */
function parseGrid(text: string): Place | null {
  try {
    const point = /^\s*\d{1,2}\s*[NS]\s+\d/i.test(text) ? Utm.parse(text).toLatLon() : Mgrs.parse(text).toUtm().toLatLon();
    return { lat: point.lat, lon: point.lon };
  } catch {
    return null;
  }
}

/** Reads any of the four notations; null when it is none of them or outside the globe. */
export function parsePlace(text: string): Place | null {
  const found = parseDecimal(text) ?? parseDms(text) ?? parseGrid(text);
  return found && Math.abs(found.lat) <= 90 && Math.abs(found.lon) <= 180 ? found : null;
}
