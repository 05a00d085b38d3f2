// What belongs to the search itself, and what somebody did with its record afterwards.
import type { EventKind, MissionEvent, Recorded } from "../wire";
import { isMain } from "./eventWeight";

/** A search is over in hours; its record is labelled, copied and supposed about for years. */
const OF_THE_RECORD: ReadonlySet<EventKind> = new Set([
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

/** What is only of interest to whoever plans or tends the program. */
const OF_THE_DESK: ReadonlySet<EventKind> = new Set([
  "mission_drafted",
  "mission_edited",
  "plan_chosen",
  "plan_vetoed",
  "flight_started",
  "place_reached",
  "place_passed",
  "order_done",
]);

/** For a searcher who was not there. */
export const isTold = (event: MissionEvent): boolean =>
  isMain(event) && !OF_THE_RECORD.has(event.kind) && !OF_THE_DESK.has(event.kind) && !(event.kind === "preflight_checked" && event.passed);
