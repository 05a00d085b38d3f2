import { expect, it } from "vitest";
import { missionAt, type MissionState } from "../state/mission";
import { bearingDeg } from "../state/geometry";
import { record, someBearing, somePlan, someSpec } from "../state/examples";
import type { LonLat } from "../wire/beliefFrame";
import { candidateFeatures, measuredFeatures, planFeatures } from "./features";

const of = (state: MissionState, ...what: string[]) =>
  measuredFeatures(state).features.filter((f) => what.includes(f.properties?.["what"]));

const drafted = { kind: "mission_drafted", spec: someSpec() } as const;

it("a bearing's line points where the bearing points, past the area", () => {
  const state = missionAt(record(drafted, someBearing({ bearing_deg: 217 })), Infinity);
  const geometry = of(state, "main")[0]!.geometry;
  const [from, to] = (geometry as GeoJSON.LineString).coordinates as [LonLat, LonLat];
  expect(bearingDeg(from, to)).toBeCloseTo(217, 0);
});

it("two peaks of one sweep stay two hypotheses", () => {
  const state = missionAt(record(drafted, someBearing({ peaks: [{ bearing_deg: 120, weight: 0.4 }] })), Infinity);
  expect([of(state, "main").length, of(state, "peak").length]).toEqual([1, 1]);
});

it("a bearing that was left out has no wedge", () => {
  const out = { kind: "bearing_excluded", bearing_id: "b1", by: "o", reason: "" } as const;
  const state = missionAt(record(drafted, someBearing(), out), Infinity);
  expect(of(state, "wedge", "main")).toEqual([]);
  expect(of(state, "excluded")).toHaveLength(1);
});

it("the newest rose is the strongest", () => {
  const state = missionAt(record(drafted, someBearing({ bearing_id: "a" }), someBearing({ bearing_id: "b" })), Infinity);
  expect(of(state, "rose").map((f) => f.properties?.["age"])).toEqual([1, 0]);
});

it("the chosen candidate is drawn last, on top", () => {
  const state = missionAt(record(drafted, somePlan()), Infinity);
  expect(candidateFeatures(state, 2).features.at(-1)!.properties).toMatchObject({ index: 1, shade: 5, lit: false });
});

it("nothing is drawn of an estimate that is not there", () => {
  expect(measuredFeatures(missionAt(record(drafted), Infinity)).features).toEqual([]);
});

it("without a fence of its own the margin around the area is shown", () => {
  expect(planFeatures(someSpec()).features.filter((f) => f.properties?.["what"] === "fence").length).toBeGreaterThan(0);
});
