// What belongs to the search itself, and what somebody did with its record afterwards. Loaded with the safety bar: small.
import type { EventKind, MissionEvent, Recorded } from "../wire";

/** A search is over in hours; its record is labelled, copied and supposed about for years. */
export const OF_THE_RECORD: ReadonlySet<EventKind> = new Set([
  "mission_labelled",
  "mission_brought_in",
  "mission_deleted",
  "mission_restored",
  "variant_kept",
  "variant_dropped",
]);

/** Told at leisure: it counts for the search, but does not stretch its time. */
const ofTheFlight = ({ kind }: MissionEvent) => !OF_THE_RECORD.has(kind) && kind !== "truth_noted";

/** The last event of the search, in the order of events; the last of all when there is nothing else. */
export const lastFlown = (all: readonly Recorded[]): Recorded | undefined => all.findLast((e) => ofTheFlight(e.event)) ?? all.at(-1);
