// The mission as map features. Pure: the same for a live mission, a review and a recording.

import type { MissionWays } from "../sources/waysApi";
import { rankCandidates, roundShade } from "../state/candidates";
import type { EmitterState } from "../state/emitter";
import { emitterColour } from "../state/emitterColours";
import { beside, boundsOf, circle, destination, distanceM, lonLat, wedge } from "../state/geometry";
import { marginOutline } from "../state/margin";
import { polarScale, radius } from "../state/polar";
import type { MissionView } from "../state/view";
import { formatDuration } from "../units/quantities";
import type { Area, MissionSpec } from "../wire";
import type { LonLat } from "../wire/beliefFrame";

export type Features = GeoJSON.FeatureCollection;

type Bearings = Pick<MissionView, "spec" | "bearings">;
type Ways = Partial<Pick<MissionView, "ways">>;

export const collection = (features: GeoJSON.Feature[]): Features => ({ type: "FeatureCollection", features });

type Coordinates = GeoJSON.Position | readonly Coordinates[];

/** In one piece across the antimeridian: each corner beside `near`. MapLibre draws 179 to -179 degrees around the world. */
function inOnePiece(coordinates: Coordinates, near: number): Coordinates {
  const [lon, ...rest] = coordinates;
  if (typeof lon === "number") return [beside(lon, near), ...(rest as number[])];
  return (coordinates as Coordinates[]).map((part) => inOnePiece(part, near));
}

function feature(geometry: GeoJSON.Geometry | Area, properties: Record<string, unknown> = {}): GeoJSON.Feature {
  const { type, coordinates } = geometry as { type: GeoJSON.GeoJsonTypes; coordinates: Coordinates };
  const near = [coordinates].flat(4)[0] as number;
  return { type: "Feature", geometry: { type, coordinates: inOnePiece(coordinates, near) } as GeoJSON.Geometry, properties };
}
const point = (at: LonLat, properties: Record<string, unknown> = {}) => feature({ type: "Point", coordinates: at }, properties);
const line = (coordinates: LonLat[], properties: Record<string, unknown> = {}) => feature({ type: "LineString", coordinates }, properties);
const polygon = (ring: LonLat[], properties: Record<string, unknown> = {}) => feature({ type: "Polygon", coordinates: [ring] }, properties);

export function areaPoints(area: Area): LonLat[] {
  return area.type === "Polygon" ? (area.coordinates.flat() as LonLat[]) : (area.coordinates.flat(2) as LonLat[]);
}

/** Past the far end of the search area, metres. */
export function reachM(spec: MissionSpec | null): number {
  const box = spec && boundsOf(areaPoints(spec.area));
  return box ? 1.15 * distanceM([box[0], box[1]], [box[2], box[3]]) : 300;
}

/** The fence as drawn, or the search area with its margin. */
function fenceFeatures(spec: MissionSpec): GeoJSON.Feature[] {
  const { fence, fence_margin_m: margin } = spec.flight;
  if (fence) return [feature(fence as Area, { what: "fence" })];
  return marginOutline(spec.area as Area, margin).map((piece) => line(piece, { what: "fence" }));
}

/** Corners of everything the vehicle may fly in. */
export function flightPoints(spec: MissionSpec): LonLat[] {
  const fence = spec.flight.fence as Area | null;
  return fence ? areaPoints(fence) : marginOutline(spec.area as Area, spec.flight.fence_margin_m).flat();
}

export function planFeatures(spec: MissionSpec | null): Features {
  if (!spec) return collection([]);
  return collection([
    feature(spec.area as Area, { what: "area" }),
    ...fenceFeatures(spec),
    ...spec.flight.no_fly.map((area) => feature(area as Area, { what: "no_fly" })),
  ]);
}

/** Roads, paths, barriers, and the way that was advised last. */
export function wayFeatures(known: MissionWays | null, advised: readonly LonLat[]): Features {
  const drawn = (known?.features ?? []).map(({ geometry, properties: { kind } }) =>
    feature(geometry as unknown as GeoJSON.Geometry, { what: geometry.type === "MultiPolygon" ? "barrier_area" : kind }),
  );
  return collection(advised.length > 1 ? [...drawn, line([...advised], { what: "advised" })] : drawn);
}

/** Measurement places so near to each other that their numbers would cover one another. */
const ONE_PLACE_M = 3;

function placeFeatures({ bearings }: Bearings): GeoJSON.Feature[] {
  const places: { at: LonLat; numbers: (number | string)[] }[] = [];
  for (const { fact } of bearings) {
    const at = lonLat(fact.place);
    const near = places.find((p) => distanceM(p.at, at) < ONE_PLACE_M);
    const called = fact.source.kind === "person" ? fact.source.name.slice(0, 12) : fact.place_number;
    if (!near) places.push({ at, numbers: [called] });
    else if (!near.numbers.includes(called)) near.numbers.push(called);
  }
  return places.map(({ at, numbers }) => point(at, { what: "place", label: numbers.join(",") }));
}

/** How long a bearing's line is, metres: to the edge of where is flown, since nothing behind it is searched; a stub at least. */
function rayLengths(spec: MissionSpec | null): (at: LonLat, bearing: number) => number {
  const reach = reachM(spec);
  if (!spec) return () => reach;
  const flown = flightPoints(spec);
  return (at, bearing) => {
    const box = boundsOf([...flown, at])!;
    const from: LonLat = [beside(at[0], (box[0] + box[2]) / 2), at[1]];
    const ahead = destination(from, bearing, 1);
    const leaves = ([0, 1] as const).map((axis) => {
      const step = ahead[axis] - from[axis];
      return step === 0 ? reach : (box[step > 0 ? axis + 2 : axis]! - from[axis]) / step;
    });
    return Math.min(reach, Math.max(reach / 6, Math.min(...leaves)));
  };
}

/** Lines and wedges (+- sigma), `quality` 0..1 (the middle of the colours without a sweep: nobody measured it), `age` 0 for the newest. Other peaks of a sweep stay hypotheses. */
function directionFeatures({ spec, bearings }: Bearings): GeoJSON.Feature[] {
  const length = rayLengths(spec);
  const ray = (at: LonLat, bearing: number) => [at, destination(at, bearing, length(at, bearing))];
  const used = bearings.filter((b) => !b.excluded);
  const counted = used.flatMap(({ fact }, i) => {
    const at = lonLat(fact.place);
    const shared = { quality: fact.sweep_id ? fact.quality : 0.775, age: used.length - 1 - i };
    return [
      polygon(wedge(at, fact.bearing_deg, fact.sigma_deg, length(at, fact.bearing_deg)), { ...shared, what: "wedge" }),
      line(ray(at, fact.bearing_deg), { ...shared, what: "main" }),
      ...fact.peaks.map((peak) => line(ray(at, peak.bearing_deg), { ...shared, what: "peak", weight: peak.weight })),
    ];
  });
  const leftOut = bearings
    .filter((b) => b.excluded)
    .map(({ fact }) => line(ray(lonLat(fact.place), fact.bearing_deg), { what: "excluded" }));
  return [...counted, ...leftOut];
}

/** Nearly all of it: what is missing then are headings that were skipped, not a side that was not looked at. */
const WHOLE_TURN_DEG = 355;

/** Received power around each measurement place as a rose; the newest strong, older ones fainter. */
function roseFeatures({ spec, bearings }: Bearings): GeoJSON.Feature[] {
  const size = reachM(spec) / 9;
  return bearings.flatMap(({ fact, excluded }, i) => {
    const scale = polarScale(fact.binned_db);
    if (!scale) return [];
    const width = 360 / fact.binned_db.length;
    const at = lonLat(fact.place);
    const isSector = fact.turn !== null && fact.turn.turned_deg < WHOLE_TURN_DEG;
    const ring = fact.binned_db.flatMap((db, bin) => {
      if (db === null) return isSector ? [at] : [];
      return [destination(at, (bin + 0.5) * width, size * radius(db, scale))];
    });
    if (ring.length < 3) return [];
    return [polygon([...ring, ring[0]!], { what: "rose", age: bearings.length - 1 - i, excluded })];
  });
}

/** The stretches of way on which something was heard that counts, or counted. */
const listenedFeatures = ({ ways = [] }: Ways): GeoJSON.Feature[] =>
  ways.flatMap(({ fact, excluded }) =>
    fact.stretches.map(({ begin, end }) => line([lonLat(begin), lonLat(end)], { what: "listened", faded: excluded ? 1 : 0 })),
  );

/** The region; once there is a bearing, the expected error as a circle and the estimate: the middle of an area is none. */
function estimateFeatures({ belief }: Pick<MissionView, "belief">): GeoJSON.Feature[] {
  const estimate = belief?.fact.estimate;
  if (!estimate) return [];
  const at = lonLat(estimate);
  const region = feature(estimate.c95 as Area, { what: "c95" });
  if (belief.fact.bearings === 0) return [region];
  return [region, polygon(circle(at, estimate.expected_rmse_m), { what: "circle" }), point(at, { what: "estimate" })];
}

type Emitters = ReadonlyMap<string, EmitterState>;

/** The estimates of all emitters of a search that has several, each in its colour with its number; the regions of those not looked at. */
function emittersFeatures(spec: MissionSpec | null, emitters: Emitters, looked: string | null): GeoJSON.Feature[] {
  if (!spec || spec.emitters.length < 2) return [];
  return spec.emitters.flatMap(({ emitter_id: id }, index) => {
    const estimate = emitters.get(id)?.belief?.fact.estimate;
    if (!estimate) return [];
    const { fill: colour, ink } = emitterColour(index);
    const marked = point(lonLat(estimate), { what: "emitter", colour, ink, label: String(index + 1) });
    return id === looked ? [marked] : [feature(estimate.c95 as Area, { what: "emitter_c95", colour }), marked];
  });
}

/** Where the emitter was found, and the way from the estimate to it. */
function truthFeatures({ belief, truth }: Partial<Pick<MissionView, "belief" | "truth">>): GeoJSON.Feature[] {
  const place = truth?.fact.place;
  if (!place) return [];
  const estimate = belief?.fact.estimate;
  const off = estimate ? [line([lonLat(estimate), lonLat(place)], { what: "truth_line" })] : [];
  return [...off, point(lonLat(place), { what: "truth" })];
}

/** What the sweeps say and what follows, told apart by `what`: one source, so that a new bearing is one upload and one repaint. */
export const measuredFeatures = (
  mission: Bearings & Ways & Pick<MissionView, "belief"> & Partial<Pick<MissionView, "emitterId" | "truth">>,
  emitters: Emitters = new Map(),
): Features =>
  collection([
    ...listenedFeatures(mission),
    ...directionFeatures(mission),
    ...roseFeatures(mission),
    ...placeFeatures(mission),
    ...estimateFeatures(mission),
    ...emittersFeatures(mission.spec, emitters, mission.emitterId ?? null),
    ...truthFeatures(mission),
  ]);

/** The best candidates, whose times stand on the map; the table has them all. */
const LABELLED = 5;

/** Nearer than this to where a bearing was taken a time would lie over the rose. */
const AT_ROSE_M = 5;

export function candidateFeatures({ plan: chosen, bearings }: Pick<MissionView, "plan" | "bearings">, lit: number | null): Features {
  const plan = chosen?.fact;
  if (!plan) return collection([]);
  const atRose = (at: LonLat) => bearings.some(({ fact }) => distanceM(at, lonLat(fact.place)) < AT_ROSE_M);
  return collection(
    rankCandidates(plan)
      .toReversed()
      .map(({ candidate, index, chosen }, from, { length }) =>
        point(lonLat(candidate), {
          index,
          shade: roundShade(candidate, plan, chosen),
          lit: index === lit,
          label: index === lit || (from >= length - LABELLED && !atRose(lonLat(candidate))) ? formatDuration(candidate.value_s) : "",
        }),
      ),
  );
}

export function pathFeatures(path: readonly LonLat[]): Features {
  return path.length < 2 ? collection([]) : collection([line([...path])]);
}
