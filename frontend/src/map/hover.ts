// Coordinates under the cursor at once; the expected time from there as soon as the cursor rests.
import { signal } from "@preact/signals";
import type { Map as GlMap, MapMouseEvent } from "maplibre-gl";
import type { ExpectedTime, Place } from "../wire";
import { placeOn } from "./placeOn";

export interface Hover {
  place: Place | null;
  expected: ExpectedTime | null;
}

const NOWHERE: Hover = { place: null, expected: null };
const REST_MS = 250;

export const hover = signal<Hover>(NOWHERE);

type Ask = (place: Place, aborted: AbortSignal) => Promise<ExpectedTime> | null;

export function watchHover(map: GlMap, ask: Ask): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let asking = new AbortController();
  const stop = () => {
    clearTimeout(timer);
    asking.abort();
  };
  const onMove = (event: MapMouseEvent) => {
    stop();
    const place = placeOn(event.lngLat);
    hover.value = { place, expected: null };
    asking = new AbortController();
    const { signal: aborted } = asking;
    timer = setTimeout(() => {
      void ask(place, aborted)?.then(
        (expected) => {
          if (!aborted.aborted) hover.value = { place, expected };
        },
        () => {
          if (!aborted.aborted) hover.value = { place, expected: null };
        },
      );
    }, REST_MS);
  };
  const onLeave = () => {
    stop();
    hover.value = NOWHERE;
  };
  map.on("mousemove", onMove);
  map.on("mouseout", onLeave);
  return () => {
    stop();
    hover.value = NOWHERE;
  };
}
