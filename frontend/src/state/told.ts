// What a search tells somebody who was not there.
import type { EventKind, MissionEvent } from "../wire";
import { isMain } from "./eventWeight";
import { OF_THE_RECORD } from "./flown";

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
