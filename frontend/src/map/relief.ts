// The ground's relief under everything else: shading and contour lines from the uploaded terrain.
import type { Map as GlMap } from "maplibre-gl";
import { contours, HEIGHTS, listTerrain } from "../sources/terrainApi";
import type { Palette } from "./palette";
import { placeOn } from "./placeOn";

const LAYERS = ["relief-shade", "relief-lines", "relief-heights"] as const;

const [LOWEST_ZOOM, HIGHEST_ZOOM] = [8, 15];
const SHADE = 0.5;

/** Adds nothing while no terrain is on the server. `below`: the lowest layer that stays above it. */
export async function addRelief(map: GlMap, colours: Palette, below: string): Promise<void> {
  const { terrains } = await listTerrain();
  if (terrains.length === 0 || map.getSource("relief")) return;
  const [west, south, east, north] = [0, 1, 2, 3].map((i) =>
    terrains.map(({ bounds }) => bounds[i]!).reduce((a, b) => (i < 2 ? Math.min(a, b) : Math.max(a, b))),
  ) as [number, number, number, number];
  const tiles = [`${HEIGHTS}{z}/{x}/{y}`];
  const bounds: [number, number, number, number] = [west, south, east, north];
  map.addSource("relief", {
    type: "raster-dem",
    encoding: "terrarium",
    tiles,
    tileSize: 256,
    bounds,
    minzoom: LOWEST_ZOOM,
    maxzoom: HIGHEST_ZOOM,
  });
  map.addLayer(
    {
      id: "relief-shade",
      type: "hillshade",
      source: "relief",
      paint: { "hillshade-exaggeration": SHADE, "hillshade-shadow-color": "#000000", "hillshade-highlight-color": "#ffffff" },
    },
    below,
  );
  const data = await contours(placeOn(map.getCenter()));
  if (!map.getSource("relief") || map.getSource("contours")) return;
  map.addSource("contours", { type: "geojson", data });
  const paint = { "line-color": colours.ink, "line-opacity": 0.35 };
  map.addLayer(
    {
      id: "relief-lines",
      type: "line",
      source: "contours",
      paint: { ...paint, "line-width": ["case", ["get", "index"], 1.2, 0.5] },
    },
    below,
  );
  map.addLayer(
    {
      id: "relief-heights",
      type: "symbol",
      source: "contours",
      filter: ["get", "index"],
      layout: {
        "symbol-placement": "line",
        "text-field": ["concat", ["to-string", ["get", "height_m"]], " m"],
        "text-font": ["sans-serif"],
        "text-size": 10,
      },
      paint: { "text-color": colours.ink, "text-halo-color": colours.halo, "text-halo-width": 1 },
    },
    below,
  );
}

export function showRelief(map: GlMap, shown: boolean): void {
  for (const id of LAYERS) if (map.getLayer(id)) map.setLayoutProperty(id, "visibility", shown ? "visible" : "none");
}
