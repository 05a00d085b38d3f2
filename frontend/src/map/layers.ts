// What is drawn over the ground, from bottom to top, and which switch shows it.
import type {
  ExpressionSpecification,
  FillLayerSpecification,
  Map as GlMap,
  LayerSpecification,
  LineLayerSpecification,
} from "maplibre-gl";
import { collection } from "./features";
import type { Palette } from "./palette";

export const SOURCES = ["plan", "overlays", "ways", "path", "measured", "candidates", "home"] as const;
export type SourceName = (typeof SOURCES)[number];

/** Tiles of 760 m at 50 degrees north, drawn to 0.1 m: a search is one or two of them, however near it is looked at. */
const MAX_TILE_ZOOM = 15;

export function addSources(map: GlMap): void {
  for (const name of SOURCES) map.addSource(name, { type: "geojson", data: collection([]), maxzoom: MAX_TILE_ZOOM });
}

export const SWITCHES = ["belief", "candidates", "bearings", "roses", "path", "fence", "relief"] as const;
export type Switch = (typeof SWITCHES)[number];

type Drawn = LayerSpecification & { metadata?: { switch?: Switch } };

const FONT = ["sans-serif"];

const of = (what: string): ExpressionSpecification => ["==", ["get", "what"], what];

const shownBy = (by: Switch | null) => (by ? { metadata: { switch: by } } : {});

/** Lines along the features of one kind; `by`: the switch that shows them, null when they always show. */
const line = (id: string, source: SourceName, what: string, by: Switch | null, paint: LineLayerSpecification["paint"]): Drawn => ({
  id,
  type: "line",
  source,
  filter: of(what),
  paint,
  ...shownBy(by),
});

/** The same, filled. */
const fill = (id: string, source: SourceName, what: string, by: Switch | null, paint: FillLayerSpecification["paint"]): Drawn => ({
  id,
  type: "fill",
  source,
  filter: of(what),
  paint,
  ...shownBy(by),
});

/** What keeps the borders apart from a photograph under them. */
function borderHalos(colours: Palette): Drawn[] {
  const paint = { "line-color": colours.halo, "line-width": 6, "line-opacity": 0.7 };
  return [
    { id: "fence-halo", type: "line", source: "plan", filter: ["any", of("fence"), of("no_fly")], paint, metadata: { switch: "fence" } },
    line("area-halo", "plan", "area", null, paint),
  ];
}

/** Layers of one source stand together: at each change of the source the map draws its tiles' outlines over the whole screen. */
export function missionLayers(colours: Palette, overMap = false): Drawn[] {
  const quality: ExpressionSpecification = [
    "interpolate-lab",
    ["linear"],
    ["get", "quality"],
    0.6,
    colours.bearingLow,
    0.95,
    colours.bearingHigh,
  ];
  const fading = (newest: number, oldest: number): ExpressionSpecification => [
    "interpolate",
    ["linear"],
    ["get", "age"],
    0,
    newest,
    4,
    oldest,
  ];
  const shade: ExpressionSpecification = [
    "match",
    ["get", "shade"],
    0,
    colours.rounds[0],
    1,
    colours.rounds[1],
    2,
    colours.rounds[2],
    3,
    colours.rounds[3],
    4,
    colours.rounds[4],
    colours.rounds[5],
  ];
  /** A person's name stands below their place, a number in it. */
  const named: ExpressionSpecification = ["case", [">", ["length", ["get", "label"]], 2], ["literal", [0, 1.5]], ["literal", [0, 0]]];
  /** Below its dot; of the chosen one below the ring that it is dragged by. */
  const underneath: ExpressionSpecification = ["case", ["==", ["get", "shade"], 5], ["literal", [0, 2]], ["literal", [0, 1.3]]];
  return [
    fill("no-fly", "plan", "no_fly", "fence", { "fill-color": colours.noFly, "fill-opacity": 0.25 }),
    ...(overMap ? borderHalos(colours) : []),
    line("no-fly-line", "plan", "no_fly", "fence", { "line-color": colours.noFly, "line-width": 2 }),
    line("fence", "plan", "fence", "fence", { "line-color": colours.fence, "line-width": 2.5, "line-dasharray": [1, 1.5] }),
    line("area", "plan", "area", null, { "line-color": colours.area, "line-width": 2, "line-dasharray": [5, 3] }),
    {
      id: "overlay-fill",
      type: "fill",
      source: "overlays",
      filter: ["==", ["geometry-type"], "Polygon"],
      layout: { visibility: "none" },
      paint: { "fill-color": ["coalesce", ["get", "fill"], colours.ink], "fill-opacity": 0.12 },
    },
    {
      id: "overlay-line",
      type: "line",
      source: "overlays",
      layout: { visibility: "none" },
      paint: { "line-color": ["coalesce", ["get", "stroke"], colours.ink], "line-width": 1.5 },
    },
    {
      id: "overlay-point",
      type: "circle",
      source: "overlays",
      filter: ["==", ["geometry-type"], "Point"],
      layout: { visibility: "none" },
      paint: { "circle-radius": 4, "circle-color": ["coalesce", ["get", "marker-color"], colours.ink] },
    },
    fill("barrier-areas", "ways", "barrier_area", null, { "fill-color": colours.water, "fill-opacity": 0.55 }),
    line("barrier-outlines", "ways", "barrier_area", null, { "line-color": colours.ink, "line-width": 1.2, "line-opacity": 0.6 }),
    line("barriers", "ways", "barrier", null, { "line-color": colours.ink, "line-width": 1.6, "line-opacity": 0.75 }),
    line("road-casing", "ways", "road", null, { "line-color": colours.halo, "line-width": 5, "line-opacity": 0.7 }),
    line("roads", "ways", "road", null, { "line-color": colours.rounds[3], "line-width": 2.6 }),
    line("paths", "ways", "path", null, { "line-color": colours.rounds[3], "line-width": 1.4, "line-dasharray": [3, 2] }),
    line("advised-way", "ways", "advised", null, { "line-color": colours.accent, "line-width": 4, "line-opacity": 0.8 }),
    {
      id: "path-halo",
      type: "line",
      source: "path",
      paint: { "line-color": colours.halo, "line-width": 5, "line-opacity": 0.6 },
      metadata: { switch: "path" },
    },
    {
      id: "path",
      type: "line",
      source: "path",
      paint: { "line-color": colours.path, "line-width": 2, "line-opacity": 0.85 },
      metadata: { switch: "path" },
    },
    line("listened", "measured", "listened", "bearings", {
      "line-color": colours.bearingHigh,
      "line-width": 7,
      "line-opacity": ["match", ["get", "faded"], 1, 0.12, 0.4],
    }),
    fill("wedges", "measured", "wedge", "bearings", { "fill-color": quality, "fill-opacity": fading(0.14, 0.05) }),
    line("bearing-halo", "measured", "main", "bearings", { "line-color": colours.halo, "line-width": 4.5, "line-opacity": 0.6 }),
    line("bearings", "measured", "main", "bearings", { "line-color": quality, "line-width": 2.2, "line-opacity": fading(1, 0.6) }),
    line("other-peaks", "measured", "peak", "bearings", {
      "line-color": quality,
      "line-width": 1.6,
      "line-dasharray": [4, 3],
      "line-opacity": ["max", 0.35, ["get", "weight"]],
    }),
    line("excluded", "measured", "excluded", "bearings", { "line-color": colours.bearingLow, "line-width": 1, "line-dasharray": [1, 4] }),
    line("c95-halo", "measured", "c95", "belief", { "line-color": colours.halo, "line-width": 5, "line-opacity": 0.7 }),
    line("c95", "measured", "c95", "belief", { "line-color": colours.c95, "line-width": 2.2 }),
    line("emitter-c95-edge", "measured", "emitter_c95", "belief", { "line-color": colours.ink, "line-width": 4, "line-opacity": 0.4 }),
    line("emitter-c95", "measured", "emitter_c95", "belief", { "line-color": ["get", "colour"], "line-width": 2 }),
    fill("roses", "measured", "rose", "roses", {
      "fill-color": colours.rose,
      "fill-opacity": ["case", ["get", "excluded"], 0.05, fading(0.35, 0.08)],
    }),
    line("rose-lines", "measured", "rose", "roses", { "line-color": colours.rose, "line-width": 1.5, "line-opacity": fading(1, 0.3) }),
    line("circle", "measured", "circle", "belief", { "line-color": colours.ink, "line-width": 1.8, "line-dasharray": [2, 2] }),
    {
      id: "candidates",
      type: "circle",
      source: "candidates",
      paint: {
        "circle-color": shade,
        "circle-radius": ["case", ["get", "lit"], 10, ["interpolate", ["linear"], ["get", "shade"], 0, 2, 4, 5.5, 5, 8]],
        "circle-stroke-color": ["case", ["get", "lit"], colours.accent, [">=", ["get", "shade"], 4], colours.halo, colours.rounds[2]],
        "circle-stroke-width": ["case", ["get", "lit"], 3, [">=", ["get", "shade"], 4], 2, 0.6],
        "circle-opacity": 0.95,
      },
      metadata: { switch: "candidates" },
    },
    {
      id: "candidate-values",
      type: "symbol",
      source: "candidates",
      filter: ["any", [">=", ["get", "shade"], 4], ["get", "lit"]],
      layout: { "text-field": ["get", "label"], "text-font": FONT, "text-size": 12, "text-offset": underneath, "text-anchor": "top" },
      paint: { "text-color": colours.ink, "text-halo-color": colours.halo, "text-halo-width": 1.6 },
      metadata: { switch: "candidates" },
    },
    {
      id: "home",
      type: "circle",
      source: "home",
      paint: { "circle-radius": 8, "circle-color": colours.halo, "circle-stroke-color": colours.ink, "circle-stroke-width": 2 },
    },
    {
      id: "home-letter",
      type: "symbol",
      source: "home",
      layout: { "text-field": "H", "text-font": FONT, "text-size": 11, "text-allow-overlap": true },
      paint: { "text-color": colours.ink },
    },
    {
      id: "places",
      type: "circle",
      source: "measured",
      filter: of("place"),
      paint: { "circle-radius": 9, "circle-color": colours.halo, "circle-stroke-color": colours.bearingHigh, "circle-stroke-width": 2 },
    },
    {
      id: "place-numbers",
      type: "symbol",
      source: "measured",
      filter: of("place"),
      layout: { "text-field": ["get", "label"], "text-font": FONT, "text-size": 12, "text-offset": named, "text-allow-overlap": true },
      paint: { "text-color": colours.ink, "text-halo-color": colours.halo, "text-halo-width": 1.6 },
    },
    {
      id: "estimate",
      type: "circle",
      source: "measured",
      filter: of("estimate"),
      paint: { "circle-radius": 5, "circle-color": colours.ink, "circle-stroke-color": colours.halo, "circle-stroke-width": 2.5 },
    },
    {
      id: "truth-line",
      type: "line",
      source: "measured",
      filter: of("truth_line"),
      paint: { "line-color": colours.ink, "line-width": 1.5, "line-dasharray": [2, 2] },
    },
    {
      id: "truth",
      type: "circle",
      source: "measured",
      filter: of("truth"),
      paint: { "circle-radius": 7, "circle-color": colours.halo, "circle-stroke-color": colours.ink, "circle-stroke-width": 3 },
    },
    {
      id: "emitters",
      type: "circle",
      source: "measured",
      filter: of("emitter"),
      paint: {
        "circle-radius": 9,
        "circle-color": ["get", "colour"],
        "circle-stroke-color": colours.halo,
        "circle-stroke-width": 2,
      },
    },
    {
      id: "emitter-numbers",
      type: "symbol",
      source: "measured",
      filter: of("emitter"),
      layout: { "text-field": ["get", "label"], "text-font": FONT, "text-size": 12, "text-allow-overlap": true },
      paint: { "text-color": ["get", "ink"] },
    },
  ];
}
