// Areas as lists of polygons: put together, measured, typed, imported.
import { parsePlace } from "../units/parsePlace";
import type { Area } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { lonLat, ringAreaM2 } from "./geometry";

/** Rings of one polygon: outline first, then holes; each closed. */
export type Rings = LonLat[][];

export const polygonsOf = (area: Area): Rings[] => (area.type === "Polygon" ? [area.coordinates as Rings] : (area.coordinates as Rings[]));

export function areaOf(polygons: readonly Rings[]): Area | null {
  const [first] = polygons;
  if (!first) return null;
  return polygons.length === 1 ? { type: "Polygon", coordinates: first } : { type: "MultiPolygon", coordinates: [...polygons] };
}

/** One ring of one of several polygons; ring 0 is the outline. */
export interface Ring {
  polygon: number;
  ring: number;
  corners: LonLat[];
}

export const ringsApart = (polygons: readonly Rings[]): Ring[] =>
  polygons.flatMap((rings, polygon) => rings.map((corners, ring) => ({ polygon, ring, corners })));

/** The polygons again; without its outline a polygon is gone, its holes too. */
export function ringsTogether(rings: readonly Ring[]): Rings[] {
  const polygons = new Map<number, Ring[]>();
  for (const one of rings) polygons.set(one.polygon, [...(polygons.get(one.polygon) ?? []), one]);
  return [...polygons.entries()]
    .toSorted(([a], [b]) => a - b)
    .map(([, own]) => own.toSorted((a, b) => a.ring - b.ring))
    .filter((own) => own[0]!.ring === 0)
    .map((own) => own.map((one) => one.corners));
}

export function areaM2(area: Area): number {
  return polygonsOf(area).reduce(
    (sum, [outline, ...holes]) => sum + ringAreaM2(outline ?? []) - holes.reduce((hole, ring) => hole + ringAreaM2(ring), 0),
    0,
  );
}

export const cornerCount = (area: Area): number =>
  polygonsOf(area).reduce((sum, rings) => sum + rings.reduce((n, ring) => n + Math.max(0, ring.length - 1), 0), 0);

export function closeRing(points: readonly LonLat[]): LonLat[] {
  const [first] = points;
  const last = points.at(-1);
  if (!first || !last) return [];
  return first[0] === last[0] && first[1] === last[1] ? [...points] : [...points, first];
}

export interface Unreadable {
  line: number;
  text: string;
}

/** Corners typed one a line, in any coordinate notation; lines that are no place are named. */
export function cornersFromText(text: string): { ring: LonLat[] } | { unreadable: Unreadable } | { tooFew: true } {
  const points: LonLat[] = [];
  for (const [index, line] of text.split("\n").entries()) {
    if (line.trim() === "") continue;
    const found = parsePlace(line);
    if (!found) return { unreadable: { line: index + 1, text: line.trim() } };
    points.push(lonLat(found));
  }
  const ring = closeRing(points);
  return ring.length < 4 ? { tooFew: true } : { ring };
}
