"""Why rollouts never compare a place that may be quicker: what the rule is, and what it buys."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class NearerThanStandoff:
    """clearance_m: from the place to the 95 % region, 0 inside it. standoff_m: what the planner keeps."""

    clearance_m: float
    standoff_m: float
    code: Literal["nearer_than_standoff"] = "nearer_than_standoff"
    english: ClassVar[Words] = Words(
        "The planner keeps {standoff_m} from the 95 % region; from here it is {clearance_m}. Any nearer, the emitter "
        "may be right below, where no bearing fits the antenna's pattern; the forecast does not know that.",
        "The distance is a setting of the mission.",
    )


@dataclass(frozen=True, slots=True)
class TellsLittleOfBias:
    """share_percent: of what the best place tells of emitter and compass together; wanted_percent is asked for."""

    share_percent: float
    wanted_percent: float
    code: Literal["tells_little_of_bias"] = "tells_little_of_bias"
    english: ClassVar[Words] = Words(
        "The planner compares only places that also show how far the compass is off; this one tells {share_percent} of "
        "what the best does, and {wanted_percent} are asked for. The forecast leaves the compass out.",
        "From another side the bearing would tell both.",
    )


@dataclass(frozen=True, slots=True)
class CrossesTooLittle:
    """crossing_deg: the widest angle at which the place's line crosses that of a bearing. needed_deg: of a claim."""

    crossing_deg: float
    needed_deg: float
    code: Literal["crosses_too_little"] = "crosses_too_little"
    english: ClassVar[Words] = Words(
        "All that a claim waits for is a bearing from another side: lines must cross at {needed_deg}, and from here "
        "they cross at {crossing_deg}. The forecast does not know that.",
        "The angle is a setting of the mission.",
    )


@dataclass(frozen=True, slots=True)
class EchoesHeardBefore:
    """away_m: from the place to the nearest turn that was made. apart_m: what the planner keeps."""

    away_m: float
    apart_m: float
    code: Literal["echoes_heard_before"] = "echoes_heard_before"
    english: ClassVar[Words] = Words(
        "The planner keeps {apart_m} from places where a turn was made; from here it is {away_m}. A bearing so near "
        "hears the same echoes again and tells hardly anything new; the forecast does not know that.",
        "Farther from all earlier turns the bearing is a witness of its own.",
    )


@dataclass(frozen=True, slots=True)
class BetweenPlaces:
    """spacing_m: of the lattice of places that are compared."""

    spacing_m: float
    code: Literal["between_places"] = "between_places"
    english: ClassVar[Words] = Words(
        "No rule forbids it: the planner compares places {spacing_m} apart with a limited number of simulated flights, "
        "and yours is better than what it found.",
    )


RuleReason = NearerThanStandoff | TellsLittleOfBias | CrossesTooLittle | EchoesHeardBefore | BetweenPlaces
