"""A past belief, rebuilt from the stored bearings exactly as the flight computed it."""

from __future__ import annotations

from collections.abc import Sequence

from backend.events import BeliefUpdated, Recorded
from backend.search.area import corner_of
from backend.search.state import SearchState, evolve
from backend.search.together import together
from backend.wire.belief_frame import encode_belief

FOLDED_KINDS = (
    "mission_drafted",
    "mission_edited",
    "area_changed",
    "mission_started",
    "bearing_measured",
    "bearing_excluded",
    "bearing_included",
    "source_mute_changed",
    "belief_updated",
    "sweep_rejected",
    "heard_on_the_way",
)
"""The events that a belief depends on."""


def belief_frame(
    mission_id: str, recorded: Sequence[Recorded], lite: bool, emitter_id: str | None = None
) -> bytes | None:
    """The belief about an emitter that stands after these events: of its last BeliefUpdated, the prior when there is
    none. emitter_id None: the first emitter.

    recorded: of FOLDED_KINDS, in order. None: they hold no specification, or no such emitter. Heavy: call it off the
    event loop.
    """
    state, seq = _last_belief(recorded, emitter_id)
    if state.spec is None or (emitter_id is not None and emitter_id not in state.emitters):
        return None
    name = emitter_id or state.mission.emitters[0].emitter_id
    tasks = together(state.mission, state.home or corner_of(state.mission.area), name)
    task = tasks.about(state, name) if seq else tasks.emitters[name]
    bearings = task.planner_bearings(state.emitters[name].bearings if seq else ())
    folded = task.belief(bearings)
    belief = task.planning_belief(bearings) if folded is None else folded
    corners = task.corners_lon_lat(belief)
    return encode_belief(mission_id, task.emitter_id, seq, len(bearings), belief.density, corners, lite=lite)


def _last_belief(recorded: Sequence[Recorded], emitter_id: str | None) -> tuple[SearchState, int]:
    """The state at the last BeliefUpdated with its number; the newest state and 0 when there is none."""
    state, found, seq = SearchState(), SearchState(), 0
    for record in recorded:
        state = evolve(state, record.event, record.at_utc.timestamp())
        if isinstance(record.event, BeliefUpdated) and record.event.emitter_id == (emitter_id or _first(state)):
            found, seq = state, record.seq
    return (found, seq) if seq else (state, 0)


def _first(state: SearchState) -> str:
    return next(iter(state.emitters))
