// Overlays chosen on the maps page: points, lines and areas from GeoJSON or KML files.
import { effect, signal } from "@preact/signals";
import { overlay } from "../sources/mapsApi";
import { keep, kept } from "../state/kept";

const KEY = "crossfix.overlays";

function stored(): string[] {
  try {
    const parsed: unknown = JSON.parse(kept(KEY) ?? "[]");
    return Array.isArray(parsed) ? parsed.filter((id): id is string => typeof id === "string") : [];
  } catch {
    return [];
  }
}

export const overlayIds = signal<readonly string[]>(stored());
export const shownOverlays = signal<GeoJSON.FeatureCollection>({ type: "FeatureCollection", features: [] });

effect(() => {
  const ids = overlayIds.value;
  keep(KEY, ids);
  void Promise.allSettled(ids.map(overlay)).then((loaded) => {
    if (overlayIds.peek() !== ids) return;
    const features = loaded.flatMap((one) => (one.status === "fulfilled" ? one.value.features : []));
    shownOverlays.value = { type: "FeatureCollection", features };
  });
});

export function showOverlay(id: string, shown: boolean): void {
  const others = overlayIds.peek().filter((other) => other !== id);
  overlayIds.value = shown ? [...others, id] : others;
}
