"""A past belief, rebuilt from the stored bearings exactly as the flight computed it."""

from __future__ import annotations

from collections.abc import Sequence

from backend.events import BeliefUpdated, Recorded
from backend.mission.area import corner_of
from backend.mission.localization import localization
from backend.mission.state import MissionState, evolve
from backend.wire.belief_frame import encode_belief

FOLDED_KINDS = (
    "mission_drafted",
    "mission_edited",
    "area_changed",
    "mission_started",
    "bearing_measured",
    "bearing_excluded",
    "belief_updated",
)
"""The events that a belief depends on."""


def belief_frame(mission_id: str, recorded: Sequence[Recorded], bearings: int, lite: bool) -> bytes | None:
    """The last belief of so many bearings, None when there was none. recorded: of FOLDED_KINDS, in order.

    0 bearings: the prior, before the start as well. Heavy: call it off the event loop.
    """
    state = _state_at(recorded, bearings)
    if state is None:
        return None
    task = localization(state.mission, state.home or corner_of(state.mission.area), state.home_amsl_m)
    _, belief = task.belief_fact(state.bearings)
    return encode_belief(mission_id, bearings, belief.density, task.corners_lon_lat(belief), lite=lite)


def _state_at(recorded: Sequence[Recorded], bearings: int) -> MissionState | None:
    state, found = MissionState(), None
    for record in recorded:
        state = evolve(state, record.event, record.at_utc.timestamp())
        prior = bearings == 0 and not state.bearings
        if prior or (isinstance(record.event, BeliefUpdated) and record.event.bearings == bearings):
            found = state
    return found
