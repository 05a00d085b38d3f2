// Do the offline maps on this server cover the search area? Asked when the area changes, said in one sentence.
import { computed, effect, signal } from "@preact/signals";
import { coverage as ask, listMaps } from "../sources/mapsApi";
import type { Area, Reason } from "../wire";
import { draft } from "./draft";

export interface Covered {
  covered: boolean;
  summary: Reason;
}

/** null: nothing to say, since there is no map or no area. */
export const coverage = signal<Covered | null>(null);

const REST_MS = 600;

const area = computed(() => (draft.value?.hasArea ? (draft.value.spec.area as Area) : null));

/** Follows the draft's area until it is stopped. */
export function watchCoverage(): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const stop = effect(() => {
    const wanted = area.value;
    clearTimeout(timer);
    coverage.value = null;
    if (!wanted) return;
    timer = setTimeout(() => {
      void listMaps()
        .then(async ({ maps }) => {
          const found = maps.length > 0 ? await ask(wanted) : null;
          if (area.peek() === wanted) coverage.value = found;
        })
        .catch(() => {
          if (area.peek() === wanted) coverage.value = null;
        });
    }, REST_MS);
  });
  return () => {
    clearTimeout(timer);
    stop();
  };
}
