// Small distances on the WGS84 ellipsoid's tangent plane; good to centimetres within the few kilometres of a search.

import type { Place } from "../wire";
import type { LonLat } from "../wire/beliefFrame";

const A = 6378137.0;
const E2 = 6.69437999014e-3;
const RAD = Math.PI / 180;

/** Metres per degree of longitude and latitude at a latitude (prime vertical and meridian radius). */
export function metresPerDegree(latDeg: number): [number, number] {
  const s2 = Math.sin(latDeg * RAD) ** 2;
  const w = 1 - E2 * s2;
  const meridian = (A * (1 - E2)) / w ** 1.5;
  const primeVertical = A / Math.sqrt(w);
  return [RAD * primeVertical * Math.cos(latDeg * RAD), RAD * meridian];
}

export const lonLat = (place: Place): LonLat => [place.lon, place.lat];
export const place = ([lon, lat]: LonLat): Place => ({ lat, lon });

/** The same meridian, at most half a turn from another: a mission may lie across the antimeridian. */
export const beside = (lon: number, other: number): number => lon + 360 * Math.round((other - lon) / 360);

/** Beside the first of them. */
export const together = (points: readonly LonLat[]): LonLat[] => points.map(([lon, lat]) => [beside(lon, points[0]![0]), lat]);

export function distanceM(a: LonLat, b: LonLat): number {
  const [mx, my] = metresPerDegree((a[1] + b[1]) / 2);
  return Math.hypot((beside(b[0], a[0]) - a[0]) * mx, (b[1] - a[1]) * my);
}

/** The point `metres` from `from` in compass direction `bearingDeg`. */
export function destination(from: LonLat, bearingDeg: number, metres: number): LonLat {
  const [mx, my] = metresPerDegree(from[1]);
  const b = bearingDeg * RAD;
  return [from[0] + (metres * Math.sin(b)) / mx, from[1] + (metres * Math.cos(b)) / my];
}

/** Compass bearing from a to b, [0, 360). */
export function bearingDeg(a: LonLat, b: LonLat): number {
  const [mx, my] = metresPerDegree((a[1] + b[1]) / 2);
  return (Math.atan2((beside(b[0], a[0]) - a[0]) * mx, (b[1] - a[1]) * my) / RAD + 360) % 360;
}

export function circle(centre: LonLat, radiusM: number, corners = 72): LonLat[] {
  const ring = Array.from({ length: corners }, (_, i) => destination(centre, (360 * i) / corners, radiusM));
  return [...ring, ring[0]!];
}

/** How far the two points are apart that lie farthest from each other, and the compass bearing of their line, [0, 180). */
export function extent(points: readonly LonLat[]): { metres: number; bearing: number } {
  const corners = hull(together(points));
  let [from, to, metres] = [corners[0], corners[0], 0];
  for (const [a, b] of antipodal(corners)) {
    const apart = distanceM(a, b);
    if (apart > metres) [from, to, metres] = [a, b, apart];
  }
  return { metres, bearing: from && to ? bearingDeg(from, to) % 180 : 0 };
}

/** Twice the area of the triangle, positive when a, b, c turn counter-clockwise. */
const turn = (a: LonLat, b: LonLat, c: LonLat): number => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);

/** The corners of the convex hull, counter-clockwise, in n log n steps (monotone chain, Andrew 1979). */
function hull(points: readonly LonLat[]): LonLat[] {
  const sorted = points.toSorted((a, b) => a[0] - b[0] || a[1] - b[1]);
  const chain = (along: readonly LonLat[]): LonLat[] => {
    const kept: LonLat[] = [];
    for (const point of along) {
      while (kept.length > 1 && turn(kept.at(-2)!, kept.at(-1)!, point) <= 0) kept.pop();
      kept.push(point);
    }
    return kept.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.toReversed())];
}

/** Pairs of corners between which a pair of parallel lines fits around the hull; the farthest two are one of them
 * (rotating calipers, Shamos 1978). A stretched plane has the same pairs, so degrees will do. */
function* antipodal(corners: readonly LonLat[]): Generator<[LonLat, LonLat]> {
  const n = corners.length;
  const at = (index: number): LonLat => corners[index % n]!;
  let across = 1;
  for (let i = 0; i < n; i++) {
    const [a, b] = [at(i), at(i + 1)];
    while (across < 2 * n && turn(a, b, at(across + 1)) > turn(a, b, at(across))) across++;
    for (const far of [at(across), at(across + 1)]) yield* [[a, far] as [LonLat, LonLat], [b, far] as [LonLat, LonLat]];
  }
}

/** A wedge of +-halfWidth around a bearing as a closed ring: apex, arc, apex. */
export function wedge(apex: LonLat, bearing: number, halfWidthDeg: number, lengthM: number): LonLat[] {
  const steps = Math.max(2, Math.ceil(halfWidthDeg));
  const arc = Array.from({ length: 2 * steps + 1 }, (_, i) => destination(apex, bearing + halfWidthDeg * (i / steps - 1), lengthM));
  return [apex, ...arc, apex];
}

type Box = [number, number, number, number];

/** [west, south, east, north] of a set of points, beyond 180 degrees where it is narrower across the antimeridian; null
 * when there is none. */
export function boundsOf(points: readonly LonLat[]): Box | null {
  if (points.length === 0) return null;
  const [plain, across] = [boxOf(points), boxOf(together(points))];
  return across[2] - across[0] < plain[2] - plain[0] ? across : plain;
}

function boxOf(points: readonly LonLat[]): Box {
  let [west, south, east, north] = [Infinity, Infinity, -Infinity, -Infinity];
  for (const [lon, lat] of points) {
    west = Math.min(west, lon);
    south = Math.min(south, lat);
    east = Math.max(east, lon);
    north = Math.max(north, lat);
  }
  return [west, south, east, north];
}

/** Area of a ring in m^2 (shoelace on the tangent plane in its middle), without sign: the same from whichever corner. */
export function ringAreaM2(corners: readonly LonLat[]): number {
  const ring = together(corners);
  const origin = boundsOf(ring);
  if (!origin) return 0;
  const [mx, my] = metresPerDegree((origin[1] + origin[3]) / 2);
  let twice = 0;
  ring.forEach((p, i) => {
    const q = ring[(i + 1) % ring.length]!;
    twice += (p[0] - origin[0]) * mx * (q[1] - origin[1]) * my - (q[0] - origin[0]) * mx * (p[1] - origin[1]) * my;
  });
  return Math.abs(twice) / 2;
}
