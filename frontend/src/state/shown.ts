// The mission that the panels and the map show: at the moment looked at, as it happened or as it is supposed.
import { computed } from "@preact/signals";
import { serverNowMs, source } from "./connection";
import { lastFlown } from "./flown";
import { events, happened, reviewTimeMs } from "./moment";
import { supposedHere } from "./supposed";
import { type MissionView, suppose } from "./view";

export const mission = computed<MissionView>(() => {
  const real = happened.value;
  const answer = supposedHere.value?.answer;
  return answer ? suppose(real, answer) : real;
});

/** The moment shown, ms UTC: of the review, of the mission's end, of the last that a recording without one tells, or now. */
export const shownTimeMs = computed<number>(() => {
  const end = mission.value.ended?.at ?? (source.value?.happensNow === false ? lastFlown(events.value)?.at_utc : undefined);
  return reviewTimeMs.value ?? (end ? Date.parse(end) : serverNowMs.value);
});
