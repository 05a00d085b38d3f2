"""Why readings taken in flight say nothing of the emitter's direction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words

WhyLeftOut = Literal[
    "heading_unknown", "place_unknown", "overdriven", "at_noise", "beside_a_turn", "pointed_one_way", "too_many"
]


@dataclass(frozen=True, slots=True)
class ReadingsLeftOut:
    """readings: so many of a leg."""

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
