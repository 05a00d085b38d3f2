// The advice asked for last, and whether it still holds: nobody has to follow it, and bearings outrun it.
import { computed, effect, signal } from "@preact/signals";
import type { Advice } from "../sources/adviceApi";
import type { LonLat } from "../wire/beliefFrame";
import { source } from "./connection";
import { emittersThen } from "./moment";
import { shownTimeMs } from "./shown";

/** Of the mission shown. */
export const advice = signal<Advice | null>(null);
effect(() => {
  void source.value;
  advice.value = null;
});

/** So many times as long as the way takes, and a little more, it is good. */
const GOOD_FOR = 2;
const LEAST_S = 300;

export type Freshness = "holds" | "outrun" | "old";

export function freshness(given: Advice, bearings: number, nowMs: number): Freshness {
  if (bearings !== given.bearings) return "outrun";
  const ageS = (nowMs - Date.parse(given.given_at_utc)) / 1000;
  return ageS > Math.max(LEAST_S, GOOD_FOR * (given.move_s ?? 0)) ? "old" : "holds";
}

export const adviceFreshness = computed<Freshness | null>(() => {
  const given = advice.value;
  if (!given) return null;
  const counted = emittersThen.value.get(given.emitter_id)?.bearings.filter((b) => !b.excluded).length ?? 0;
  return freshness(given, counted, shownTimeMs.value);
});

export const advised = computed<LonLat | null>(() => {
  const place = advice.value?.place;
  return place && adviceFreshness.value === "holds" ? [place.lon, place.lat] : null;
});

/** The way there; empty when nothing is advised. */
export const advisedWay = computed<LonLat[]>(() => (advised.value ? ((advice.value?.way ?? []) as LonLat[]) : []));
