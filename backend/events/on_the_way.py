"""What a craft heard in flight, between places."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from backend.events.bearings import BearingSource
from backend.events.fact import Fact
from backend.reasons import Reason
from backend.spec import Id, Place

MOST_PACKED = 100_000
"""Characters; the longest leg has a tenth of it."""


class StretchFact(Fact):
    """A stretch of way that counts, as it is drawn. turned_deg: between the outermost directions of the antenna."""

    begin: Place
    end: Place
    turned_deg: float


class HeardOnTheWay(Fact):
    """One leg to a place, and what was heard of an emitter meanwhile; of joint errors alone it changes the belief.

    leg_id: by which it is left out, as a bearing by its bearing_id. counted: power samples behind the readings.
    left_out: of those that say nothing, how many and why. nose: what it did meanwhile, where it swung. readings:
    hardware's WayReadings, packed, in metres from `origin`; None: no stretch says anything. gain_db: (36,) of the
    antenna, as in SilenceFact. sigma_deg: of a bearing that the sensor would have taken; no stretch counts for more.
    """

    kind: Literal["heard_on_the_way"] = "heard_on_the_way"
    emitter_id: Id
    source: BearingSource
    leg_id: str
    place_number: int
    counted: int
    left_out: list[Reason]
    nose: list[Reason]
    stretches: list[StretchFact]
    origin: Place
    readings: Annotated[str, Field(max_length=MOST_PACKED)] | None
    gain_db: Annotated[list[Annotated[float, Field(le=0)]], Field(min_length=1, max_length=360)]
    sigma_deg: Annotated[float, Field(ge=0.1, le=180)]

    @property
    def tells(self) -> bool:
        """Whether it is anything to a belief."""
        return self.readings is not None
