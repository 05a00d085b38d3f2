"""The mission itself: what it is to do, and how its search ended."""

from __future__ import annotations

from typing import Literal

from backend.events.craft import Phase
from backend.events.fact import Fact
from backend.reasons import Reason
from backend.spec import MissionSpec, SearchArea

MissionPhase = Literal["draft", "ready", "searching", "done", "aborted", "failed"] | Phase
"""A mission in one word: what its craft does while one flies, else the stage of its search."""

Outcome = Literal["localized", "not_localized", "aborted", "failed"]


class MissionDrafted(Fact):
    """The first fact of every mission."""

    kind: Literal["mission_drafted"] = "mission_drafted"
    spec: MissionSpec


class MissionEdited(Fact):
    """The whole specification, before the start only; a checklist that passed counts no more."""

    kind: Literal["mission_edited"] = "mission_edited"
    spec: MissionSpec


class AreaChanged(Fact):
    """In hold, in flight: from here on this is searched. The bearings taken before count on."""

    kind: Literal["area_changed"] = "area_changed"
    search: SearchArea
    by: str


class ServerRestarted(Fact):
    """From here on beliefs are computed anew; a craft that we flew is held until an operator resumes."""

    kind: Literal["server_restarted"] = "server_restarted"


class MissionEnded(Fact):
    """The search is over; a craft of it may still be on its way home."""

    kind: Literal["mission_ended"] = "mission_ended"
    outcome: Outcome
    reason: Reason
    mission_time_s: float
