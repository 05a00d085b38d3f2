import { describe, expect, it } from "vitest";
import type { LonLat } from "../wire/beliefFrame";
import { areaOf, closeRing } from "./areas";
import { destination, distanceM } from "./geometry";
import { marginOutline } from "./margin";

const square = (at: LonLat, side: number): LonLat[] => {
  const east = destination(at, 90, side);
  return closeRing([at, east, destination(east, 0, side), destination(at, 0, side)]);
};

describe("the margin around an area", () => {
  const area = areaOf([[square([7, 50], 200)]])!;

  it("keeps its distance everywhere", () => {
    const corners = square([7, 50], 200);
    for (const p of marginOutline(area, 60).flat()) {
      expect(Math.min(...corners.map((c) => distanceM(c, p)))).toBeGreaterThan(59.9);
    }
  });

  it("is as long as the outline and a circle together, for a convex area", () => {
    const length = marginOutline(area, 60).reduce((sum, l) => sum + l.slice(1).reduce((s, p, i) => s + distanceM(l[i]!, p), 0), 0);
    expect(length / (4 * 200 + 2 * Math.PI * 60)).toBeCloseTo(1, 1);
  });

  it("is nothing without a margin", () => {
    expect(marginOutline(area, 0)).toEqual([]);
  });

  it("is worked out again only for another area or margin", () => {
    const before = marginOutline(area, 60);
    expect(marginOutline(area, 60)).toBe(before);
    expect(marginOutline(area, 61)).not.toBe(before);
    expect(marginOutline({ ...area }, 60)).not.toBe(before);
  });

  it("takes bounded steps along the edges of an area across 180 degrees", () => {
    const across = closeRing([[179.99, -17] as LonLat, [-179.99, -17], [-179.99, -17.01], [179.99, -17.01]]);
    expect(marginOutline(areaOf([[across]])!, 60).flat().length).toBeLessThan(4000);
  });
});
