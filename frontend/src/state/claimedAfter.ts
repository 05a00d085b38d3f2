// When an emitter was found, from the start of the mission on.
import type { Recorded } from "../wire";

/** Seconds from the start until the claim that stands in the end was first made; null: none stands, or nobody started. */
export function claimedAfterS(events: readonly Recorded[], emitterId: string): number | null {
  let began: number | null = null;
  let since: number | null = null;
  for (const { event, at_utc: at } of events) {
    if (event.kind === "mission_started") began ??= Date.parse(at);
    if (event.kind !== "belief_updated" || event.emitter_id !== emitterId) continue;
    since = event.localized ? (since ?? Date.parse(at)) : null;
  }
  return began === null || since === null ? null : (since - began) / 1000;
}
