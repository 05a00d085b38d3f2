import { expect, it } from "vitest";
import { bearingDeg, boundsOf, distanceM, metresPerDegree } from "../state/geometry";
import { missionAt } from "../state/mission";
import { type MissionView, viewOf } from "../state/view";
import type { MissionEvent } from "../wire";
import type { LonLat } from "../wire/beliefFrame";
import { excluded, record, someBearing, someBelief, someLeg, somePlan, someSpec } from "../wire/examples";
import { candidateFeatures, flightPoints, measuredFeatures, planFeatures } from "./features";

const of = (state: MissionView, ...what: string[]) => measuredFeatures(state).features.filter((f) => what.includes(f.properties?.what));

const drafted = { kind: "mission_drafted", spec: someSpec() } as const;
const seen = (...events: MissionEvent[]) => viewOf(missionAt(record(drafted, ...events), Infinity));

const mainLine = (state: MissionView) => (of(state, "main")[0]!.geometry as GeoJSON.LineString).coordinates as [LonLat, LonLat];

it.each([217, 37])("a bearing's line points to %d and ends at the edge of where is flown", (bearing_deg) => {
  const [west, south, east, north] = boundsOf(flightPoints(someSpec()))!;
  const middle = { lon: (west + east) / 2, lat: (south + north) / 2 };
  const [from, [lon, lat]] = mainLine(seen(someBearing({ bearing_deg, place: middle })));
  expect(bearingDeg(from, [lon, lat])).toBeCloseTo(bearing_deg, 0);
  const [mx, my] = metresPerDegree(lat);
  const inside = [lon - west, east - lon].map((d) => d * mx).concat([lat - south, north - lat].map((d) => d * my));
  expect(Math.min(...inside)).toBeCloseTo(0, 0);
});

it("a bearing that points out of where is flown is still seen", () => {
  const [west, south] = boundsOf(flightPoints(someSpec()))!;
  const [from, to] = mainLine(seen(someBearing({ bearing_deg: 225, place: { lon: west, lat: south } })));
  expect(distanceM(from, to)).toBeGreaterThan(20);
});

it("the place of a bearing that somebody reported has their name, not a number", () => {
  const state = seen(someBearing({ source: { kind: "person", name: "Ada" }, place_number: 0 }));
  expect(of(state, "place").map((f) => f.properties?.label)).toEqual(["Ada"]);
});

it("a bearing without a sweep is drawn as of middling quality, as nobody measured it", () => {
  const told = someBearing({ sweep_id: null, quality: 1, peaks: [] });
  expect(of(seen(told), "main", "wedge").map((f) => f.properties?.quality)).toEqual([0.775, 0.775]);
  expect(of(seen(someBearing({ quality: 0.8 })), "main").map((f) => f.properties?.quality)).toEqual([0.8]);
});

it("two peaks of one sweep stay two hypotheses", () => {
  const state = seen(someBearing({ peaks: [{ bearing_deg: 120, weight: 0.4 }] }));
  expect([of(state, "main").length, of(state, "peak").length]).toEqual([1, 1]);
});

it("a bearing that was left out has no wedge", () => {
  const state = seen(someBearing(), excluded("b1"));
  expect(of(state, "wedge", "main")).toEqual([]);
  expect(of(state, "excluded")).toHaveLength(1);
});

it("stretches that were listened on are drawn, faded when their leg was left out", () => {
  const drawn = of(seen(someLeg({ leg_id: "a" })), "listened");
  expect(drawn.map((f) => (f.geometry as GeoJSON.LineString).coordinates[0])).toEqual([
    [7, 50],
    [7, 50.0002],
  ]);
  expect(drawn.map((f) => f.properties?.faded)).toEqual([0, 0]);
  expect(of(seen(someLeg({ leg_id: "a" }), excluded("a")), "listened").map((f) => f.properties?.faded)).toEqual([1, 1]);
});

it("the newest rose is the strongest", () => {
  const state = seen(someBearing({ bearing_id: "a" }), someBearing({ bearing_id: "b" }));
  expect(of(state, "rose").map((f) => f.properties?.age)).toEqual([1, 0]);
});

it("the chosen candidate is drawn last, on top", () => {
  const state = seen(somePlan());
  expect(candidateFeatures(state, 2).features.at(-1)!.properties).toMatchObject({ index: 1, shade: 5, lit: false });
});

it("no time lies over a rose, unless its candidate is pointed at", () => {
  const [first, ...others] = somePlan().candidates;
  const state = seen(someBearing({ place: { lat: first!.lat, lon: first!.lon } }), somePlan());
  const labels = (lit: number | null) =>
    Object.fromEntries(candidateFeatures(state, lit).features.map(({ properties }) => [properties!.index, properties!.label !== ""]));
  expect(labels(null)).toEqual({ 0: false, ...Object.fromEntries(others.map((_, i) => [i + 1, true])) });
  expect(labels(0)[0]).toBe(true);
});

it("of several emitters each has its number and colour, and those not looked at their region", () => {
  const spec = { ...someSpec(), emitters: ["a", "b", "c"].map((id) => ({ ...someSpec().emitters[0]!, emitter_id: id })) };
  const beliefs = ["a", "b"].map((emitter_id) => someBelief({ emitter_id }));
  const state = missionAt(record({ kind: "mission_drafted", spec }, ...beliefs), Infinity);
  const drawn = measuredFeatures(viewOf(state, null, "b"), state.emitters).features;
  const properties = (what: string) => drawn.filter((f) => f.properties?.what === what).map((f) => f.properties!);
  expect(properties("emitter").map((p) => p.label)).toEqual(["1", "2"]);
  expect(new Set(properties("emitter").map((p) => p.colour)).size).toBe(2);
  expect(properties("emitter_c95").map((p) => p.colour)).toEqual([properties("emitter")[0]!.colour]);
  expect(properties("c95")).toHaveLength(1);
});

it("without a bearing the region is drawn and no estimate in its middle", () => {
  const drawn = (bearings: number) => measuredFeatures(seen(someBelief({ bearings }))).features.map((f) => f.properties?.what);
  expect(drawn(0)).toEqual(["c95"]);
  expect(drawn(1)).toEqual(["c95", "circle", "estimate"]);
});

it("nothing is drawn of an estimate that is not there", () => {
  expect(measuredFeatures(seen()).features).toEqual([]);
});

it("without a fence of its own the margin around the area is shown", () => {
  expect(planFeatures(someSpec()).features.filter((f) => f.properties?.what === "fence").length).toBeGreaterThan(0);
});

it("what lies across the antimeridian is drawn in one piece, not around the world", () => {
  const ring = [
    [179.998, 50],
    [-179.998, 50],
    [-179.998, 50.004],
    [179.998, 50.004],
    [179.998, 50],
  ];
  const spec = someSpec();
  const across = { ...spec, area: { type: "Polygon", coordinates: [ring] } } as typeof spec;
  const there = { ...across, flight: { ...spec.flight, no_fly: [{ type: "MultiPolygon", coordinates: [[ring]] }] } } as typeof spec;
  const drawn = planFeatures(there).features;
  expect(new Set(drawn.map((f) => f.properties?.what))).toEqual(new Set(["area", "fence", "no_fly"]));
  for (const { geometry } of drawn) {
    const numbers = (geometry as GeoJSON.Polygon).coordinates.flat(3) as unknown as number[];
    const lons = numbers.filter((_, i) => i % 2 === 0);
    expect(Math.max(...lons) - Math.min(...lons)).toBeLessThan(0.1);
  }
});
