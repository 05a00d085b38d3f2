import { describe, expect, it } from "vitest";
import { beliefPixels, cividis, contrast, imageCorners, opacity } from "./beliefImage";

it("cividis runs from dark blue to yellow and only gets lighter", () => {
  const light = ([r, g, b]: [number, number, number]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
  const steps = Array.from({ length: 101 }, (_, i) => light(cividis(i / 100)));
  expect(cividis(0)).toEqual([0, 34, 78]);
  expect(cividis(1)).toEqual([254, 232, 56]);
  for (let i = 1; i < steps.length; i++) expect(steps[i]).toBeGreaterThanOrEqual(steps[i - 1]! - 0.3);
});

it("no red and no amber: those are for alerts", () => {
  for (let i = 0; i <= 100; i++) {
    const [r, g] = cividis(i / 100);
    expect(r - g).toBeLessThan(30);
  }
});

describe("beliefPixels", () => {
  it("puts the southern row last and leaves the impossible clear", () => {
    const pixels = beliefPixels({ nx: 1, ny: 8, cells: Float32Array.of(1, 0, 0, 0, 0, 0, 0, 0) });
    expect(pixels[3]).toBe(0);
    expect(pixels[31]).toBeGreaterThan(200);
  });
});

it("a belief that knows nothing is drawn faintly, one that knows strongly", () => {
  const uniform = new Float32Array(100).fill(1);
  const sharp = Float32Array.from({ length: 100 }, (_, i) => (i === 7 ? 1 : 1e-3));
  expect(opacity(contrast(uniform))).toBeLessThan(0.5);
  expect(contrast(sharp)).toBe(1);
});

it("opacity is nothing at nothing and grows", () => {
  expect(opacity(0)).toBe(0);
  expect(opacity(0.1)).toBeLessThan(opacity(0.2));
  expect(opacity(1)).toBeLessThanOrEqual(1);
});

it.each([
  [179.995, -179.997, 179.995, 180.003],
  [179.997, -179.995, -180.003, -179.995],
])("a picture across the antimeridian from %d to %d is in one piece with its middle where MapLibre takes it", (west, east, from, to) => {
  const corners = imageCorners({
    bounds: [
      [west, 50],
      [east, 50],
      [east, 50.01],
      [west, 50.01],
    ],
  });
  for (const [i, lon] of [from, to, to, from].entries()) expect(corners[i]![0]).toBeCloseTo(lon, 9);
});
