// How much an event of a mission matters, and which kind of thing it tells.
import type { MissionEvent } from "../wire";

/** How much an event matters to somebody who skims. */
export function isMain(event: MissionEvent): boolean {
  switch (event.kind) {
    case "phase_changed":
    case "command_accepted":
    case "sweep_started":
    case "alert_acknowledged":
    case "alert_cleared":
    case "belief_updated":
    case "order_tried":
      return false;
    case "heard_on_the_way":
      return event.readings !== null;
    case "authority_changed":
      return event.by !== null || event.authority.taken_by !== null;
    default:
      return true;
  }
}

export type EventTone = "bearing" | "decision" | "alert" | "mode" | "other";

export function toneOf(event: MissionEvent): EventTone {
  switch (event.kind) {
    case "bearing_measured":
    case "sweep_rejected":
    case "heard_on_the_way":
    case "bearing_excluded":
    case "bearing_included":
    case "source_mute_changed":
    case "recording_imported":
      return "bearing";
    case "plan_chosen":
    case "plan_vetoed":
    case "priorities_changed":
      return "decision";
    case "alert_raised":
    case "order_not_done":
    case "link_lost":
    case "safety_vetoed":
    case "command_refused":
    case "place_refused":
      return "alert";
    case "phase_changed":
    case "authority_changed":
    case "hold_ordered":
    case "resume_ordered":
    case "return_ordered":
    case "land_ordered":
    case "abort_ordered":
    case "automatic_changed":
    case "battery_countdown_started":
    case "battery_countdown_stopped":
    case "area_changed":
    case "control_changed":
    case "mission_started":
    case "mission_ended":
      return "mode";
    default:
      return "other";
  }
}
