// The small basemap that ships (Natural Earth, public domain): for looking from afar; it fades out before its lines mislead.
import type { ExpressionSpecification, Map as GlMap } from "maplibre-gl";
import { type World, world } from "../sources/mapsApi";
import type { Palette } from "./palette";

/** At 7 its lines stray by two pixels, at 9.5 by ten. */
const [FADES_FROM, GONE_AT] = [7, 9.5];
/** Tiles of the zoom that shows them last. */
const MAX_TILE_ZOOM = 8;

function line(steps: readonly number[], scale: number): [number, number][] {
  let [x, y] = [0, 0];
  return Array.from({ length: steps.length / 2 }, (_, i) => {
    x += steps[2 * i]!;
    y += steps[2 * i + 1]!;
    return [x / scale, y / scale];
  });
}

export function worldFeatures({ scale, land, lakes, rivers, towns }: World): GeoJSON.FeatureCollection {
  const surfaces = (what: string, all: number[][][]): GeoJSON.Feature[] =>
    all.map((rings) => ({
      type: "Feature",
      properties: { what },
      geometry: { type: "Polygon", coordinates: rings.map((ring) => line(ring, scale)) },
    }));
  const features: GeoJSON.Feature[] = [
    ...surfaces("land", land),
    ...surfaces("lake", lakes),
    ...rivers.map(
      (river): GeoJSON.Feature => ({
        type: "Feature",
        properties: { what: "river" },
        geometry: { type: "LineString", coordinates: line(river, scale) },
      }),
    ),
    ...towns.map(
      ([x, y, rank, name]): GeoJSON.Feature => ({
        type: "Feature",
        properties: { what: "town", rank, name },
        geometry: { type: "Point", coordinates: [x / scale, y / scale] },
      }),
    ),
  ];
  return { type: "FeatureCollection", features };
}

let asked: Promise<World> | null = null;

/** Until the server is asked once more for what it did not give. */
const AGAIN_MS = 3000;

const of = (what: string): ExpressionSpecification => ["==", ["get", "what"], what];
const fading = <T extends number | string>(near: T, far: T): ExpressionSpecification => [
  "interpolate",
  ["linear"],
  ["zoom"],
  FADES_FROM,
  far,
  GONE_AT,
  near,
];

async function add(map: GlMap, colours: Palette, below: string, isGone: () => boolean): Promise<void> {
  asked ??= world();
  const data = worldFeatures(await asked);
  if (isGone() || map.getSource("world") || !map.getLayer(below)) return;
  map.addSource("world", { type: "geojson", data, maxzoom: MAX_TILE_ZOOM });
  map.setPaintProperty("ground", "background-color", fading(colours.ground, colours.water));
  const shared = { source: "world", maxzoom: GONE_AT } as const;
  map.addLayer({ ...shared, id: "world-land", type: "fill", filter: of("land"), paint: { "fill-color": colours.land } }, below);
  map.setPaintProperty("world-land", "fill-color", fading(colours.ground, colours.land));
  const water = { "fill-color": colours.water, "fill-opacity": fading(0, 1) };
  map.addLayer({ ...shared, id: "world-lakes", type: "fill", filter: of("lake"), paint: water }, below);
  const flowing = { "line-color": colours.river, "line-opacity": fading(0, 1), "line-width": 1 };
  map.addLayer({ ...shared, id: "world-rivers", type: "line", minzoom: 3, filter: of("river"), paint: flowing }, below);
  map.addLayer(
    {
      ...shared,
      id: "world-towns",
      type: "symbol",
      filter: ["all", of("town"), ["<=", ["get", "rank"], ["+", ["zoom"], 1]]],
      layout: {
        "text-field": ["get", "name"],
        "text-font": ["sans-serif"],
        "text-size": 11,
        "symbol-sort-key": ["get", "rank"],
        "text-padding": 6,
      },
      paint: { "text-color": colours.town, "text-halo-color": colours.land, "text-halo-width": 1.5, "text-opacity": fading(0, 1) },
    },
    below,
  );
}

/** Under everything, and only once the map is seen from so far; while the server does not answer the ground stays plain. */
export function addWorld(map: GlMap, colours: Palette, below: string): void {
  let again: ReturnType<typeof setTimeout> | undefined;
  let gone = false;
  map.once("remove", () => {
    gone = true;
    clearTimeout(again);
  });
  const look = () => {
    if (map.getZoom() >= GONE_AT) return;
    map.off("zoom", look);
    void add(map, colours, below, () => gone).catch(() => {
      asked = null;
      if (gone) return;
      again = setTimeout(() => {
        map.on("zoom", look);
        look();
      }, AGAIN_MS);
    });
  };
  map.on("zoom", look);
  look();
}
