// Offline map packages and overlays on this server.

import type { Area } from "../wire";
import type { components } from "../wire/generated";
import { json, requestEmpty, withBody } from "./api";

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
export const overlay = (id: string) => json<GeoJSON.FeatureCollection>(`/overlays/${id}`);
export const deleteOverlay = (id: string) => requestEmpty(`/overlays/${id}`, { method: "DELETE" });
