"""After the flight: where the emitter really was, and how the mission is kept in the library."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from backend.events.fact import Fact
from backend.spec import Id, Place

Tag = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=40, pattern=r"^[^\x00-\x1f]*$")]
TruthWay = Literal["map", "typed", "phone"]
"""How a place was told: tapped on the map, written or pasted, taken from the position of a phone standing there."""


class TruthNoted(Fact):
    """Somebody found the emitter, or looked for it and did not (`place` None); the last word on an emitter counts.

    accuracy_m: of the place as its teller knows it, None when nobody said.
    """

    kind: Literal["truth_noted"] = "truth_noted"
    emitter_id: Id
    place: Place | None
    accuracy_m: Annotated[float, Field(ge=0, le=10_000)] | None
    how: TruthWay
    by: str


class MissionLabelled(Fact):
    """Its name in the list, and what people say about it; the specification stays as it was flown."""

    kind: Literal["mission_labelled"] = "mission_labelled"
    name: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=120)]
    tags: Annotated[list[Tag], Field(max_length=20)]
    notes: Annotated[str, StringConstraints(max_length=4000)]
    by: str


class MissionBroughtIn(Fact):
    """All facts before this one are of another installation, brought in with a bundle.

    software: that wrote the bundle, "" when it named none.
    """

    kind: Literal["mission_brought_in"] = "mission_brought_in"
    software: Annotated[str, StringConstraints(max_length=80)]
    by: str


class MissionDeleted(Fact):
    """Out of the list; everything of it is kept for some days more."""

    kind: Literal["mission_deleted"] = "mission_deleted"
    by: str


class MissionRestored(Fact):
    """Back in the list."""

    kind: Literal["mission_restored"] = "mission_restored"
    by: str
