// What somebody typed or pasted as a place.

import type { Place } from "../wire";
import { parseGrid } from "./gridNotation";

/** "50,62" is half a place with a decimal comma, not two whole numbers. */
function parseDecimal(text: string): Place | null {
  const found = /^\s*(?![+-]?\d+,\d+\s*$)([+-]?\d+(?:\.\d+)?)\s*°?\s*([NS])?[\s,;]+([+-]?\d+(?:\.\d+)?)\s*°?\s*([EW])?\s*$/i.exec(text);
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

/** Reads any of the four notations; null when it is none of them or outside the globe. */
export function parsePlace(text: string): Place | null {
  const found = parseDecimal(text) ?? parseDms(text) ?? parseGrid(text);
  return found && Math.abs(found.lat) <= 90 && Math.abs(found.lon) <= 180 ? found : null;
}
