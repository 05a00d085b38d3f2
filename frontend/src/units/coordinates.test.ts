import { beforeAll, describe, expect, it } from "vitest";
import { type CoordinateFormat, formatPlace, readGridNotation } from "./coordinates";
import { parsePlace } from "./parsePlace";

const tower = { lat: 48.8582, lon: 2.2945 };

it("gives degrees until the grid's notation is read", () => {
  expect(formatPlace(tower, "utm")).toBe("48.85820 N 2.29450 E");
});

describe("formatPlace", () => {
  beforeAll(readGridNotation);

  it.each([
    ["dd", "48.85820 N 2.29450 E"],
    ["dms", "48°51′29.5″ N 002°17′40.2″ E"],
    ["utm", "31 N 448252 5411933"],
    ["mgrs", "31U DQ 48251 11932"],
  ] as [CoordinateFormat, string][])("%s", (format, expected) => {
    expect(formatPlace(tower, format)).toBe(expected);
  });

  it("carries a minute that rounds up", () => {
    expect(formatPlace({ lat: 9.9999999, lon: -0.00000001 }, "dms")).toBe("10°00′00.0″ N 000°00′00.0″ W");
  });

  it("falls back to degrees where no grid is defined", () => {
    expect(formatPlace({ lat: 88, lon: 10 }, "mgrs")).toBe("88.00000 N 10.00000 E");
  });
});

describe("parsePlace", () => {
  it("reads back what it wrote, in every notation, on all four quarters of the globe", () => {
    for (const place of [tower, { lat: -33.4567, lon: -70.6483 }, { lat: 40.7, lon: -74.01 }, { lat: -6.2, lon: 106.8 }]) {
      for (const [format, tolerance] of [
        ["dd", 1e-5],
        ["dms", 3e-5],
        ["utm", 2e-5],
        ["mgrs", 3e-5],
      ] as [CoordinateFormat, number][]) {
        const read = parsePlace(formatPlace(place, format));
        expect(Math.abs(read!.lat - place.lat), `${format} ${formatPlace(place, format)}`).toBeLessThan(tolerance);
        expect(Math.abs(read!.lon - place.lon), format).toBeLessThan(tolerance);
      }
    }
  });

  it("reads plain pairs with sign, comma or semicolon", () => {
    expect(parsePlace("-33.5, -70.6")).toEqual({ lat: -33.5, lon: -70.6 });
    expect(parsePlace("50.5;7.2")).toEqual({ lat: 50.5, lon: 7.2 });
    expect(parsePlace("50, 7")).toEqual({ lat: 50, lon: 7 });
    expect(parsePlace("50.62,7")).toEqual({ lat: 50.62, lon: 7 });
    for (const half of ["50,62", " -50,62 "]) expect(parsePlace(half)).toBeNull();
    expect(parsePlace("33.5 S 70.6 W")).toEqual({ lat: -33.5, lon: -70.6 });
  });

  it("says nothing about what is no place", () => {
    for (const text of ["", "here", "50", "91 7", "50 181", "50.5 N"]) expect(parsePlace(text)).toBeNull();
  });
});
