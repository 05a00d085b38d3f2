// @vitest-environment happy-dom
import { expect, test } from "vitest";
import type { Profile } from "../sources/terrainApi";
import { profilePaths } from "./ProfileCard";

const leg: Profile = {
  distance_m: [0, 50, 100],
  ground_m: [100, 120, 100],
  altitude_amsl_m: 150,
  home_amsl_m: 100,
  lowest_m: 100,
  highest_m: 120,
  minimum_clearance_m: 20,
  maximum_above_ground_m: 120,
  known: true,
  objections: [],
};

test("the ground is an area, the clearance a line above it and the way a line above both", () => {
  const { ground, clearance, way } = profilePaths(leg);
  expect(ground).toBe("M0.0 85.7L50.0 57.1L100.0 85.7V100H0Z");
  expect(clearance).toBe("M0.0 57.1L50.0 28.6L100.0 57.1");
  expect(way).toBe("M0 14.3H100");
});

test("ground that is not known is a gap", () => {
  const { ground } = profilePaths({ ...leg, ground_m: [100, null, 100] });
  expect(ground).toBe("M0.0 85.7M100.0 85.7");
});
