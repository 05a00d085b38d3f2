"""What the mission does now and what it waits for, in the operator's words. Pure."""

from __future__ import annotations

from backend.mission.state import MissionState


def doing(state: MissionState) -> str:
    """One line for the top bar."""
    number = state.place_number
    match state.phase:
        case "draft":
            return "draft: nothing has flown"
        case "ready":
            return "ready to start"
        case "taking_off":
            return "taking off"
        case "planning" if not state.belief_current:
            return "updating the belief"
        case "planning":
            return f"choosing place {number + 1}"
        case "waiting":
            return f"place {number} is proposed"
        case "flying":
            return f"flying to place {number}"
        case "measuring":
            again = f", attempt {state.attempt}" if state.attempt > 1 else ""
            return f"taking a bearing at place {number}{again}"
        case "hold":
            return f"holding: {state.phase_reason}"
        case "manual":
            return f"the pilot has control: {state.phase_reason}"
        case "returning":
            return f"returning home: {state.phase_reason}"
        case "landing":
            return "landing at home"
        case "done" | "aborted" | "failed":
            return state.phase_reason


def waits_for(state: MissionState) -> str | None:
    """What has to happen before it goes on by itself; None when it goes on by itself."""
    match state.phase:
        case "draft" | "ready":
            return "an operator to start"
        case "waiting":
            return "an operator to accept, refuse or move the place"
        case "hold" if "vehicle" in state.links_down:
            return "the vehicle's link, then an operator to resume"
        case "hold":
            return "an operator to resume"
        case "manual":
            return "the pilot to give control back, then an operator to resume"
        case _:
            return None
