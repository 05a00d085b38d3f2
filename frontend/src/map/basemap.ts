// The offline package and the overlays that lie under the mission, chosen on the maps page.
import { signal } from "@preact/signals";
import type { Map as GlMap, LayerSpecification, SourceSpecification } from "maplibre-gl";
import { mapLayers } from "../sources/mapsApi";
import { drop, kept } from "../state/kept";
import type { Reason } from "../wire";
import { preparePmtiles } from "./createMap";

const KEY = "crossfix.basemap";

/** Id of the package shown; null: the plain grid. */
export const basemap = signal<string | null>(kept(KEY));

export function chooseBasemap(id: string | null): void {
  basemap.value = id;
  if (id === null) {
    drop(KEY);
    return;
  }
  try {
    localStorage.setItem(KEY, id);
  } catch {
    // a full storage: it is shown as long as the page
  }
}

/** Puts the chosen package under everything else of a loaded map. Returns what could not be drawn. */
export async function addBasemap(map: GlMap, theme: "light" | "dark", below: string): Promise<Reason[]> {
  const id = basemap.peek();
  if (id === null) return [];
  const [{ source_id, source, layers, notes }] = await Promise.all([mapLayers(id, theme), preparePmtiles()]);
  if (map.getSource(source_id)) return notes;
  const url = String(source.url ?? "").replace("pmtiles:///", `pmtiles://${location.origin}/`);
  map.addSource(source_id, { ...source, url } as unknown as SourceSpecification);
  for (const layer of layers) map.addLayer(layer as unknown as LayerSpecification, below);
  return notes;
}
