// Terrain on this server: files of heights, and the ground below the next leg.
import type { Place } from "../wire";
import type { components } from "../wire/generated";
import { json, problemOf, requestEmpty } from "./api";

type Schemas = components["schemas"];
export type TerrainList = Schemas["TerrainList"];
export type Profile = Schemas["Profile"];

const at = ({ lat, lon }: Place) => `lat=${lat}&lon=${lon}`;

export const listTerrain = () => json<TerrainList>("/terrain");
export const deleteTerrain = (id: string) => requestEmpty(`/terrain/${id}`, { method: "DELETE" });
export const contours = (place: Place) => json<GeoJSON.FeatureCollection>(`/terrain/contours?${at(place)}`);
export const profile = (missionId: string, place: Place) => json<Profile>(`/missions/${missionId}/profile?${at(place)}`);

/** Before a tile's zoom, column and row: it is fetched here, in its turn. */
export const HEIGHTS = "heights://";

export async function tileOfHeights(address: string, signal: AbortSignal): Promise<ArrayBuffer> {
  const response = await fetch(address.replace(HEIGHTS, "/api/terrain/tiles/"), { signal });
  if (!response.ok) throw await problemOf(response);
  return response.arrayBuffer();
}
