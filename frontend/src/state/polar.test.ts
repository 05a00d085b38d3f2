import { describe, expect, it } from "vitest";
import { arcPath, binnedPath, polarPoint, polarScale, radius } from "./polar";

it("north is up, east is right", () => {
  expect(polarPoint(0, 1)).toEqual([expect.closeTo(0), expect.closeTo(-1)]);
  expect(polarPoint(90, 1)).toEqual([expect.closeTo(1), expect.closeTo(0)]);
});

describe("an arc", () => {
  const numbers = (path: string) => path.match(/-?\d+(\.\d+)?(e-\d+)?/g)!.map(Number);
  it("goes clockwise, the long way round when it is wider than half the circle", () => {
    const [x0, y0, rx, , , long, clockwise, x1, y1] = numbers(arcPath(0, 270, 1));
    expect([x0, y0, rx, long, clockwise, x1, y1]).toEqual([
      expect.closeTo(0),
      expect.closeTo(-1),
      1,
      1,
      1,
      expect.closeTo(-1),
      expect.closeTo(0),
    ]);
    expect(numbers(arcPath(350, 40, 1))[5]).toBe(0);
  });
  it("is drawn in two halves when it is the whole circle, which one arc cannot be", () => {
    expect(arcPath(90, 360, 1).match(/A/g)).toHaveLength(2);
  });
});

describe("the scale", () => {
  it("puts the loudest on the rim and never stretches noise over the whole plot", () => {
    const scale = polarScale([-60, -61, null, -60.5])!;
    expect(radius(-60, scale)).toBe(1);
    expect(radius(-61, scale)).toBeGreaterThan(0.9);
  });
  it("is none when nothing was heard", () => {
    expect(polarScale([null, null])).toBeNull();
  });
  it("is not upset by a missing number", () => {
    expect(polarScale([NaN, -50])!.topDb).toBe(-50);
  });
});

describe("the path over the bins", () => {
  const scale = { topDb: 0, spanDb: 20 };
  it("is closed when every bin was heard", () => {
    expect(binnedPath([0, -1, -2, -3], scale)).toMatch(/^M.*Z$/);
  });
  it("breaks where nothing was heard", () => {
    expect(binnedPath([0, -1, null, -3, -4], scale).match(/M/g)).toHaveLength(2);
  });
  it("draws a bin that was heard alone, as of a pulsed tag", () => {
    expect(binnedPath([null, 0, null, -3, null, null], scale).match(/h0/g)).toHaveLength(2);
    expect(binnedPath([0, null, null, -3, -4, null], scale).match(/h0/g)).toHaveLength(1);
    expect(binnedPath([0, null, null, -1], scale)).not.toContain("h0");
  });
});
