"""The mission itself: what it is to do, and how its search ended."""

from __future__ import annotations

from typing import Annotated, Any, Literal, cast

from pydantic import BeforeValidator

from backend.events.craft import Phase
from backend.events.fact import Fact
from backend.reasons import Reason
from backend.spec import LONGEST_S, Id, MissionSpec, Priority, SearchArea

MissionPhase = Literal["draft", "ready", "searching", "done", "aborted", "failed"] | Phase
"""A mission in one word: what its craft does while one flies, else the stage of its search."""

Outcome = Literal["localized", "not_localized", "aborted", "failed"]


def _with_bounded_timers(spec: object) -> object:
    """Timers had no upper bound at first: a stored mission with a longer one is read with the longest there is now."""
    if not isinstance(spec, dict):
        return spec
    stored = cast(dict[str, Any], spec)
    timers = stored.get("timers")
    if not isinstance(timers, dict):
        return stored
    bounded = {
        name: min(value, LONGEST_S[name]) if name in LONGEST_S and isinstance(value, int | float) else value
        for name, value in cast(dict[str, Any], timers).items()
    }
    return stored | {"timers": bounded}


StoredSpec = Annotated[MissionSpec, BeforeValidator(_with_bounded_timers)]


class MissionDrafted(Fact):
    """The first fact of every mission."""

    kind: Literal["mission_drafted"] = "mission_drafted"
    spec: StoredSpec


class MissionEdited(Fact):
    """The whole specification, before the start only; a checklist that passed counts no more. by: None in journals of
    before it was kept."""

    kind: Literal["mission_edited"] = "mission_edited"
    spec: StoredSpec
    by: str | None = None


class AreaChanged(Fact):
    """In hold, in flight: from here on this is searched. The bearings taken before count on."""

    kind: Literal["area_changed"] = "area_changed"
    search: SearchArea
    by: str


class PrioritiesChanged(Fact):
    """From here on places are chosen in this order of importance; emitters that are not named come last. What the
    others waited for before counts no more."""

    kind: Literal["priorities_changed"] = "priorities_changed"
    priorities: dict[Id, Priority]
    by: str


class ServerRestarted(Fact):
    """From here on beliefs are computed afresh; a craft that we flew is held until an operator resumes."""

    kind: Literal["server_restarted"] = "server_restarted"


class MissionEnded(Fact):
    """The search is over; a craft of it may still be on its way home."""

    kind: Literal["mission_ended"] = "mission_ended"
    outcome: Outcome
    reason: Reason
    mission_time_s: float
