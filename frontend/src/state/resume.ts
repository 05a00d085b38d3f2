// Whether resuming would be accepted now, as the server says it once a second.
import { computed } from "@preact/signals";
import type { Reason } from "../wire";
import { live } from "./connection";
import { flying } from "./flying";

/** Why it would be refused; null: it would not, or nobody says so. */
export const resumeRefused = computed<Reason | null>(() => {
  const target = flying.value;
  const craft = live.value.status?.value.crafts.find(({ craft_id }) => craft_id === target?.craftId);
  return craft?.phase === target?.phase ? (craft?.resume_refused ?? null) : null;
});
