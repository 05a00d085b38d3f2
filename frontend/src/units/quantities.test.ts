import { expect, it } from "vitest";
import { formatAge, formatArea, formatBearing, formatDuration, formatLength, formatSpeed } from "./quantities";

it("lengths keep a decimal while they are small", () => {
  expect(formatLength(9.84, "metric")).toBe("9.8 m");
  expect(formatLength(313.4, "metric")).toBe("313 m");
  expect(formatLength(50, "metric")).toBe("50 m");
  expect(formatLength(2500, "metric")).toBe("2.50 km");
  expect(formatLength(10, "imperial")).toBe("32.8 ft");
  expect(formatLength(3218.688, "imperial")).toBe("2.00 mi");
});

it("areas and speeds", () => {
  expect(formatArea(4100, "metric")).toBe("4,100 m²");
  expect(formatArea(250_000, "metric")).toBe("0.25 km²");
  expect(formatArea(40_468.56, "imperial")).toBe("10.00 acres");
  expect(formatSpeed(10, "imperial")).toBe("22.4 mph");
});

it("durations are minutes and seconds", () => {
  expect(formatDuration(130)).toBe("2:10");
  expect(formatDuration(59.6)).toBe("1:00");
  expect(formatDuration(3725)).toBe("1:02:05");
  expect(formatDuration(-4)).toBe("0:00");
});

it("bearings are three digits from 000 to 359", () => {
  expect(formatBearing(7.4)).toBe("007°");
  expect(formatBearing(359.7)).toBe("000°");
  expect(formatBearing(-90)).toBe("270°");
});

it("ages are short", () => {
  expect(formatAge(4.2)).toBe("4 s");
  expect(formatAge(200)).toBe("3 min");
});
