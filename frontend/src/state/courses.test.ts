import { expect, it } from "vitest";
import type { CoursePoint, MissionCourses } from "../sources/coursesApi";
import { errorTicks, lastSecond, linesOf, minuteStep, stepPath } from "./courses";

const point = (t_s: number, expected_rmse_m: number | null): CoursePoint => ({
  t_s,
  bearings: 1,
  expected_rmse_m,
  c95_area_m2: null,
  error_m: null,
  inside: null,
  localized: false,
});

const flown = [point(60, 80), point(120, 20)];
const missions: MissionCourses[] = [
  {
    mission_id: "a",
    name: "A",
    emitter_id: "emitter-1",
    emitters: [],
    ended_s: 300,
    bearings_s: [60, 120],
    courses: [
      { name: null, wanted: null, points: flown, problem: null },
      { name: "blunt", wanted: null, points: [point(60, 90)], problem: null },
    ],
  },
  { mission_id: "b", name: "B", emitter_id: "emitter-1", emitters: [], ended_s: null, bearings_s: [400], courses: [] },
];

it("puts every course on one axis, each under its own name", () => {
  expect(linesOf(missions).map((l) => [l.key, l.variant])).toEqual([
    ["a/", null],
    ["a/blunt", "blunt"],
  ]);
  expect(lastSecond(missions)).toBe(400);
  expect(lastSecond([])).toBe(60);
});

it("writes no more than eight minutes along the axis", () => {
  for (const seconds of [60, 480, 481, 3000, 7200, 90_000]) expect(seconds / 60 / minuteStep(seconds)).toBeLessThanOrEqual(8);
});

it("takes in all expected errors between round ones", () => {
  expect(errorTicks(linesOf(missions))).toEqual([20, 50, 100]);
  expect(errorTicks([])).toEqual([1, 10, 100]);
});

it("holds each value until the next and leaves a gap where nothing was estimated", () => {
  const same = (v: number) => v;
  expect(stepPath(flown, same, same, 300)).toBe("M60.0 80.0H120.0V20.0H300.0");
  expect(stepPath([point(1, 5), point(2, null), point(3, 4)], same, same, 9)).toBe("M1.0 5.0H2.0M3.0 4.0H9.0");
});
