"""Why readings taken in flight say nothing of the emitter's direction, and why the nose swung no more."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words

WhyLeftOut = Literal[
    "heading_unknown", "place_unknown", "overdriven", "at_noise", "beside_a_turn", "pointed_one_way", "too_many"
]

SwingsEnd = Literal["near_place", "not_ours", "lags", "refused"]


@dataclass(frozen=True, slots=True)
class ReadingsLeftOut:
    """readings: how many of a leg's readings were left out."""

    why: WhyLeftOut
    readings: int
    code: Literal["readings_left_out"] = "readings_left_out"

    english: ClassVar[Words] = Words(
        "{readings|reading|readings} left out: {why?heading_unknown=no heading was heard near enough in time"
        "|place_unknown=the vehicle was not sure where it was|overdriven=the receiver was overdriven"
        "|at_noise=hardly above the noise|beside_a_turn=beside a place where it turns and listens anyway"
        "|pointed_one_way=the antenna pointed one way, so their power shows no direction"
        "|too_many=other stretches of the way turned further}."
    )


@dataclass(frozen=True, slots=True)
class NoseSwung:
    """swung: sides that it came to; none on a short leg. rate_deg_s, lag_deg: as seen."""

    swung: int
    amplitude_deg: float
    rate_deg_s: float
    lag_deg: float
    end: SwingsEnd
    code: Literal["nose_swung"] = "nose_swung"

    english: ClassVar[Words] = Words(
        "The nose swung by {amplitude_deg} to either side, {swung|time|times} to the end, at {rate_deg_s} and at most "
        "{lag_deg} behind{end?near_place=, until the place was near|not_ours=, until another order or another pilot"
        "|lags=. Then it did not follow, and was left alone"
        "|refused=. Then the autopilot refused, and it was left alone}."
    )
