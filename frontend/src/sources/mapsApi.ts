// Offline map packages and overlays on this server.

import type { Area } from "../wire";
import type { components } from "../wire/generated";
import { json, requestEmpty, withBody } from "./api";
import { inPlace, places } from "./places";

type Schemas = components["schemas"];
export type MapPackage = Schemas["MapPackage"];
export type MapList = Schemas["MapList"];
export type MapLayers = Schemas["MapLayers"];
export type Coverage = Schemas["Coverage"];
export type Overlay = Schemas["Overlay"];
export type OverlayList = Schemas["OverlayList"];

/** As `backend/maps/make_basemap.py` writes it: lines by steps in units of 1/scale degree; towns by x, y, rank, name. */
export interface World {
  scale: number;
  land: number[][][];
  lakes: number[][][];
  rivers: number[][];
  towns: [number, number, number, string][];
}

export const world = () => json<World>("/basemap");
export const listMaps = () => json<MapList>("/maps");
export const mapLayers = (id: string, theme: "light" | "dark") => json<MapLayers>(`/maps/${id}/layers?theme=${theme}`);
export const deleteMap = (id: string) => requestEmpty(`/maps/${id}`, { method: "DELETE" });
export const coverage = (area: Area) => json<Coverage>("/maps/coverage", withBody("POST", { area }));
export const listOverlays = () => json<OverlayList>("/overlays");

/** Tiles and overlays come two at a time: however slow they are, there is a place for what somebody waits for. */
const inMapPlace = places(2);
export const overlay = (id: string) => inMapPlace(() => json<GeoJSON.FeatureCollection>(`/overlays/${id}`));

const TILE_MS = 20_000;

/** wanted: by the map, which no longer is when it has moved on. */
export function inTilePlace<T>(load: (ends: AbortController) => Promise<T>, wanted: AbortSignal): Promise<T> {
  const timed = () =>
    new Promise<T>((resolve, reject) => {
      const ends = new AbortController();
      const end = AbortSignal.any([wanted, AbortSignal.timeout(TILE_MS)]);
      end.throwIfAborted();
      end.addEventListener("abort", () => {
        ends.abort(end.reason);
        reject(end.reason); // an archive's first bytes are read for all of its tiles, and heed nobody's end
      });
      load(ends).then(resolve, reject);
    });
  return inMapPlace(() => inPlace(timed, wanted), wanted);
}

export const deleteOverlay = (id: string) => requestEmpty(`/overlays/${id}`, { method: "DELETE" });
