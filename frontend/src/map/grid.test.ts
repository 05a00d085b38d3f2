import { expect, it } from "vitest";
import { gridLines, niceStep } from "./grid";

it("steps are 1, 2 or 5 times a power of ten, never finer than asked", () => {
  for (const metres of [0.3, 1, 1.2, 7, 48, 99, 3200]) {
    const step = niceStep(metres);
    expect(step).toBeGreaterThanOrEqual(metres);
    expect([1, 2, 5]).toContain(Math.round(step / 10 ** Math.floor(Math.log10(step) + 1e-9)));
  }
});

it("lines stay where they are when the map moves", () => {
  const at = (west: number) => gridLines({ west, south: 50, east: west + 0.01, north: 50.01 }, 1, [7, 50]).lines;
  const xs = (lines: GeoJSON.FeatureCollection) =>
    lines.features
      .flatMap((f) => (f.geometry.type === "LineString" ? [f.geometry.coordinates] : []))
      .filter(([a, b]) => a![0] === b![0])
      .map(([a]) => a![0]!.toFixed(9));
  const first = new Set(xs(at(7)));
  const moved = xs(at(7.004)).filter((x) => Number(x) <= 7.01);
  expect(moved.length).toBeGreaterThan(2);
  for (const x of moved) expect(first.has(x)).toBe(true);
});

it("draws at most 400 lines, however far the map is zoomed out", () => {
  const { lines } = gridLines({ west: -180, south: -80, east: 180, north: 80 }, 0.01, [0, 0]);
  expect(lines.features.length).toBeLessThanOrEqual(400);
});
