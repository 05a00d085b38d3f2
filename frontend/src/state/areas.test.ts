import { describe, expect, it } from "vitest";
import type { LonLat } from "../wire/beliefFrame";
import { areaM2, areaOf, closeRing, cornerCount, cornersFromText, polygonsOf, type Rings, ringsApart, ringsTogether } from "./areas";
import { circle, destination } from "./geometry";

const square = (at: LonLat, side: number): LonLat[] => {
  const east = destination(at, 90, side);
  return closeRing([at, east, destination(east, 0, side), destination(at, 0, side)]);
};

it("an area is its polygons, one or many", () => {
  const one: Rings[] = [[square([7, 50], 100)]];
  const two: Rings[] = [...one, [square([7.01, 50], 50)]];
  expect(areaOf([])).toBeNull();
  expect(areaOf(one)?.type).toBe("Polygon");
  expect(polygonsOf(areaOf(two)!)).toEqual(two);
  expect(areaM2(areaOf(two)!)).toBeCloseTo(12_500, -1);
  expect(cornerCount(areaOf(two)!)).toBe(8);
});

it("a hole is not searched", () => {
  const outline = square([7, 50], 100);
  const hole = square(destination(destination([7, 50], 90, 20), 0, 20), 10);
  expect(areaM2(areaOf([[outline, hole]])!)).toBeCloseTo(9_900, -1);
});

describe("corners that were typed", () => {
  it("become a closed ring, in any notation", () => {
    const found = cornersFromText("50.0 N 7.0 E\n\n50.0, 7.01\n50°00′36.0″ N 7°00′36.0″ E\n");
    expect("ring" in found && found.ring).toEqual([
      [7, 50],
      [7.01, 50],
      [expect.closeTo(7.01), expect.closeTo(50.01)],
      [7, 50],
    ]);
  });

  it("name the line that is no place", () => {
    expect(cornersFromText("50 7\nover there\n51 7")).toEqual({ unreadable: { line: 2, text: "over there" } });
  });

  it("are at least three", () => {
    expect(cornersFromText("50 7\n51 7")).toEqual({ tooFew: true });
  });
});

it("a closed ring stays as it is", () => {
  const ring = circle([7, 50], 10, 12);
  expect(closeRing(ring)).toEqual(ring);
});

it("polygons come apart into rings and together again, holes with their outline", () => {
  const meadow: Rings = [square([7, 50], 100), square([7.0002, 50.0002], 10), square([7.0006, 50.0006], 10)];
  const wood: Rings = [square([7.1, 50], 100)];
  const apart = ringsApart([meadow, wood]);
  expect(apart).toHaveLength(4);
  expect(ringsTogether(apart.toReversed())).toEqual([meadow, wood]);
  expect(ringsTogether(apart.filter((r) => r.polygon !== 0 || r.ring !== 1))).toEqual([[meadow[0], meadow[2]], wood]);
  expect(ringsTogether(apart.filter((r) => r.polygon !== 0 || r.ring !== 0))).toEqual([wood]);
});
