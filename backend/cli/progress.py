"""A mission's facts as lines for a terminal."""

from __future__ import annotations

from backend.events import AlertRaised, BeliefUpdated, Event, MissionEnded, PhaseChanged
from planner.reason import sentence_of, text_of


def progress_line(event: Event) -> str | None:
    """What somebody who waits for the end wants to read; None of most facts."""
    match event:
        case PhaseChanged(craft_id=craft_id, after=after, reason=reason):
            return f"{craft_id}: {after.replace('_', ' ')}: {text_of(reason)}"
        case BeliefUpdated(emitter_id=emitter_id, measured_estimate=estimate) if estimate is not None:
            known = "localized" if event.localized else "not yet localized"
            return f"{emitter_id}: {known}, expected error {estimate.expected_rmse_m:.1f} m"
        case AlertRaised(level=level, reason=reason):
            return f"{level}: {sentence_of(reason)}"
        case MissionEnded(reason=reason):
            return f"the search has ended: {text_of(reason)}"
        case _:
            return None
