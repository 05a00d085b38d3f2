// The margin around an area that a craft keeps inside, as lines for the map.
import type { Area } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { polygonsOf } from "./areas";
import { beside, metresPerDegree } from "./geometry";

type Edge = [number, number, number, number];

/** Of a long edge; one on the wrong side of the globe would take millions. */
const MOST_STEPS = 200;

const isWithin = (distance: number, [x, y]: [number, number], [ax, ay, bx, by]: Edge): boolean => {
  const [dx, dy] = [bx - ax, by - ay];
  const along = Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
  return (x - ax - along * dx) ** 2 + (y - ay - along * dy) ** 2 <= distance ** 2;
};

let last: { area: Area; marginM: number; lines: LonLat[][] } | null = null;

/** The outline of an area with a margin around it, as lines. The last is kept: the form asks again with every letter. */
export function marginOutline(area: Area, marginM: number): LonLat[][] {
  if (last?.area !== area || last.marginM !== marginM) last = { area, marginM, lines: outlined(area, marginM) };
  return last.lines;
}

/** Offset edges and corner arcs that no other edge swallows. */
function outlined(area: Area, marginM: number): LonLat[][] {
  const rings = polygonsOf(area).map(([outline]) => outline ?? []);
  const origin = rings[0]?.[0];
  if (!origin || !(marginM > 0)) return [];
  const [mx, my] = metresPerDegree(origin[1]);
  const outlines = rings.map((ring) => ring.map(([lon, lat]): LonLat => [beside(lon, origin[0]), lat]));
  const edges = outlines.flatMap((ring) =>
    ring.slice(1).map((b, i): Edge => {
      const a = ring[i]!;
      return [(a[0] - origin[0]) * mx, (a[1] - origin[1]) * my, (b[0] - origin[0]) * mx, (b[1] - origin[1]) * my];
    }),
  );
  const isInside = ([x, y]: [number, number]) => {
    let inside = false;
    for (const [ax, ay, bx, by] of edges) if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) inside = !inside;
    return inside;
  };
  let swallower: Edge | undefined; // mostly that of the point before
  const isFree = (p: [number, number]) => {
    const swallows = (edge: Edge) => isWithin(marginM * 0.999, p, edge);
    if (swallower && swallows(swallower)) return false;
    swallower = edges.find(swallows);
    return !swallower && !isInside(p);
  };
  const lines: LonLat[][] = [];
  const keep = (points: [number, number][]) => {
    let run: LonLat[] = [];
    for (const p of [...points, null]) {
      if (p && isFree(p)) run.push([origin[0] + p[0] / mx, origin[1] + p[1] / my]);
      else {
        if (run.length > 1) lines.push(run);
        run = [];
      }
    }
  };
  for (const [ax, ay, bx, by] of edges) {
    const length = Math.hypot(bx - ax, by - ay);
    if (length === 0) continue;
    const [nx, ny] = [((by - ay) / length) * marginM, (-(bx - ax) / length) * marginM];
    const steps = Math.min(MOST_STEPS, Math.max(8, Math.ceil(length / 5)));
    for (const side of [1, -1]) {
      keep(
        Array.from({ length: steps + 1 }, (_, i) => {
          const s = i / steps;
          return [ax + s * (bx - ax) + side * nx, ay + s * (by - ay) + side * ny];
        }),
      );
    }
    keep(
      Array.from({ length: 91 }, (_, i) => {
        const angle = (i / 90) * 2 * Math.PI;
        return [ax + marginM * Math.cos(angle), ay + marginM * Math.sin(angle)];
      }),
    );
  }
  return lines;
}
