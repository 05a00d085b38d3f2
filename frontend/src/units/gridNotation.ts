// UTM and MGRS by the geodesy library.

import Mgrs, { LatLon as MgrsLatLon } from "geodesy/mgrs.js";
import Utm, { LatLon as UtmLatLon } from "geodesy/utm.js";
import type { Place } from "../wire";

/** Of a place between 80 S and 84 N. */
export function formatGrid({ lat, lon }: Place, format: "utm" | "mgrs"): string {
  if (format === "mgrs") return new MgrsLatLon(lat, lon).toUtm().toMgrs().toString(10);
  const utm = new UtmLatLon(lat, lon).toUtm();
  return `${utm.zone} ${utm.hemisphere} ${utm.easting.toFixed(0)} ${utm.northing.toFixed(0)}`;
}

/** UTM and MGRS parsers throw on anything else; null then. */
export function parseGrid(text: string): Place | null {
  try {
    const point = /^\s*\d{1,2}\s*[NS]\s+\d/i.test(text) ? Utm.parse(text).toLatLon() : Mgrs.parse(text).toUtm().toLatLon();
    return { lat: point.lat, lon: point.lon };
  } catch {
    return null;
  }
}
