// A MapLibre map that needs nothing from outside: plain grid, or an offline package from this server.

import { signal } from "@preact/signals";
import {
  AttributionControl,
  addProtocol,
  type GeoJSONSource,
  Map as GlMap,
  NavigationControl,
  ScaleControl,
  type StyleSpecification,
  setWorkerUrl,
} from "maplibre-gl";
import workerUrl from "maplibre-gl/dist/maplibre-gl-worker.mjs?worker&url";
import { t } from "../i18n";
import { inTilePlace } from "../sources/mapsApi";
import { tileOfHeights } from "../sources/terrainApi";
import type { UnitSystem } from "../units/quantities";
import type { LonLat } from "../wire/beliefFrame";
import { gridLines } from "./grid";
import type { Palette } from "./palette";
import { addWorld } from "./world";

setWorkerUrl(workerUrl);

addProtocol("heights", ({ url }, { signal }) => inTilePlace(async (ends) => ({ data: await tileOfHeights(url, ends.signal) }), signal));

let pmtilesReady: Promise<void> | null = null;

/** PMTiles is read in ranges from this server; its client is loaded when the first package is shown. */
export function preparePmtiles(): Promise<void> {
  pmtilesReady ??= import("pmtiles").then(({ Protocol }) => {
    const { tile } = new Protocol();
    addProtocol("pmtiles", (asked, { signal }) => inTilePlace((ends) => tile(asked, ends), signal));
  });
  return pmtilesReady;
}

export function hasWebgl(): boolean {
  try {
    return document.createElement("canvas").getContext("webgl2") !== null;
  } catch {
    return false;
  }
}

const EMPTY: GeoJSON.FeatureCollection = { type: "FeatureCollection", features: [] };

/** Farther away the world is drawn, and squares of kilometres would say nothing. */
const GRID_FROM_ZOOM = 9;

function plainStyle(colours: Palette): StyleSpecification {
  return {
    version: 8,
    sources: { grid: { type: "geojson", data: EMPTY } },
    layers: [
      { id: "ground", type: "background", paint: { "background-color": colours.ground } },
      {
        id: "grid",
        type: "line",
        source: "grid",
        minzoom: GRID_FROM_ZOOM,
        paint: { "line-color": ["case", ["get", "major"], colours.gridMajor, colours.grid], "line-width": 1 },
      },
    ],
  };
}

/** Where the camera was, so that another theme or page shows the same place. */
let lastCamera: { center: LonLat; zoom: number } | null = null;

/** The mission or draft that the camera was put to last, by any map: another one is framed again. */
export const framed: { what: string | null } = { what: null };

/** Step of the plain grid now, m. */
export const gridStepM = signal<number | null>(null);

const EARTH_PIXEL_M = 78271.517;

export function createMap(container: HTMLElement, colours: Palette, units: UnitSystem, start: LonLat): GlMap {
  const map = new GlMap({
    container,
    style: plainStyle(colours),
    center: lastCamera?.center ?? start,
    zoom: lastCamera?.zoom ?? 15.5,
    attributionControl: false,
    dragRotate: false,
    pitchWithRotate: false,
    maxPitch: 0,
    fadeDuration: 0,
    locale: {
      "Map.Title": t("map.label"),
      "NavigationControl.ZoomIn": t("map.zoomIn"),
      "NavigationControl.ZoomOut": t("map.zoomOut"),
    },
  });
  map.touchZoomRotate.disableRotation();
  map.keyboard.disableRotation();
  map.addControl(new NavigationControl({ showCompass: false }), "top-right");
  map.addControl(new ScaleControl({ maxWidth: 140, unit: units }), "bottom-right");
  map.addControl(new AttributionControl({ compact: false, customAttribution: "" }), "bottom-right");
  const anchor: LonLat = lastCamera?.center ?? start;
  const redrawGrid = () => {
    const { lng, lat } = map.getCenter();
    lastCamera = { center: [lng, lat], zoom: map.getZoom() };
    const b = map.getBounds();
    const metresPerPixel = (EARTH_PIXEL_M * Math.cos((lat * Math.PI) / 180)) / 2 ** map.getZoom();
    const width = b.getEast() - b.getWest();
    const height = b.getNorth() - b.getSouth();
    const box = {
      west: b.getWest() - width / 2,
      east: b.getEast() + width / 2,
      south: b.getSouth() - height / 2,
      north: b.getNorth() + height / 2,
    };
    const { stepM, lines } = gridLines(box, metresPerPixel, anchor);
    gridStepM.value = map.getZoom() < GRID_FROM_ZOOM ? null : stepM;
    map.getSource<GeoJSONSource>("grid")?.setData(lines);
  };
  map.on("load", () => {
    redrawGrid();
    addWorld(map, colours, "grid");
  });
  map.on("moveend", redrawGrid);
  return map;
}

/** Pixels that the map's controls and its scale cover along its edges; tools, and half a rose beside them, stand at the top left. */
const COVERED = { top: 14, right: 62, bottom: 44, left: 14 };
const TOOLS = { width: 170, height: 110 };

/** As large as it can be seen, below the tools or beside them. bannerPx: what an alert covers besides, at the top. */
export function fit(map: GlMap, box: [number, number, number, number], animate: boolean, bannerPx = 0): void {
  const share = Math.min(1, map.getContainer().clientHeight / 360);
  const bottom = share * COVERED.bottom;
  const beside = { ...COVERED, bottom, top: COVERED.top + bannerPx, left: TOOLS.width };
  const ways = [beside, { ...COVERED, bottom, top: share * TOOLS.height + bannerPx }].map((padding) => ({
    padding,
    zoom: map.cameraForBounds(box, { padding })?.zoom ?? -1,
  }));
  const { padding } = ways.reduce((best, way) => (way.zoom > best.zoom + 0.01 ? way : best));
  map.fitBounds(box, { padding, maxZoom: 18.5, duration: animate ? 400 : 0 });
}
