// The mission that the panels and the map show: at the moment looked at, as it happened or as it is supposed.
import { computed } from "@preact/signals";
import { serverNowMs } from "./connection";
import { happened, reviewTimeMs } from "./moment";
import { supposedHere } from "./supposed";
import { type MissionView, suppose } from "./view";

export const mission = computed<MissionView>(() => {
  const real = happened.value;
  const answer = supposedHere.value?.answer;
  return answer ? suppose(real, answer) : real;
});

/** The moment shown, ms UTC: of the review, of the mission's end, or now. */
export const shownTimeMs = computed<number>(() => {
  const ended = mission.value.ended;
  return reviewTimeMs.value ?? (ended ? Date.parse(ended.at) : serverNowMs.value);
});
