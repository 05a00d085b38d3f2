import { describe, expect, it } from "vitest";
import { linePath, spread, ticks } from "./Chart";

describe("spread", () => {
  it("keeps a steady value in the middle of at least ten units", () => {
    expect(spread([-80, null, -80])).toEqual([-85, -75]);
  });
  it("leaves room above and below what varies more", () => {
    expect(spread([0, 40])).toEqual([-1, 41]);
  });
  it("is there before anything was heard", () => {
    expect(spread([null])).toEqual([0, 10]);
  });
});

describe("ticks", () => {
  it("are two to five round values within the span", () => {
    for (const [low, high] of [
      [-85, -75],
      [-1, 41],
      [0, 10],
      [99.2, 1203],
    ] as const) {
      const at = ticks([low, high]);
      expect(at.length).toBeGreaterThanOrEqual(2);
      expect(at.length).toBeLessThanOrEqual(5);
      expect(at.every((value) => value >= low && value <= high)).toBe(true);
    }
    expect(ticks([-1, 41])).toEqual([0, 20, 40]);
  });
});

describe("linePath", () => {
  it("runs from the first moment to the last, higher values higher", () => {
    expect(linePath([10, 20], [0, 5], [10, 20], [0, 10])).toBe("M0.00 100.00L100.00 50.00");
  });
  it("has a gap where nothing was heard", () => {
    expect(linePath([0, 1, 2, 3, 4], [1, 1, null, 1, 1], [0, 4], [0, 2])).toBe("M0.00 50.00L25.00 50.00M75.00 50.00L100.00 50.00");
  });
});
