"""Why a craft turned as far as it did for a sweep: how the sector was chosen, and why it stopped or went on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class WholeTurn:
    """A sector is not turned here."""

    because: Literal["first", "again", "unsure", "wide", "several", "pulsed", "second_place"]
    code: Literal["whole_turn"] = "whole_turn"
    english: ClassVar[Words] = Words(
        "A whole turn: {because?first=nothing was heard here or elsewhere before|again=the sweep before gave no bearing"
        "|unsure=the bearings so far contradict each other|wide=the emitter may be in almost any direction"
        "|several=several emitters are listened to|pulsed=a tag's pulses need every heading"
        "|second_place=the first places of this search hear all directions}."
    )


@dataclass(frozen=True, slots=True)
class SectorExpected:
    """share: of the directions expected from here."""

    width_deg: float
    share_percent: float
    code: Literal["sector_expected"] = "sector_expected"
    english: ClassVar[Words] = Words(
        "A sector of {width_deg}: it holds {share_percent} of the directions expected from here, and a margin."
    )


@dataclass(frozen=True, slots=True)
class MaximumSeen:
    """The bearing lies well within the headings heard, and little speaks for another direction."""

    turned_deg: float
    inside_deg: float
    elsewhere_percent: float
    code: Literal["maximum_seen"] = "maximum_seen"
    english: ClassVar[Words] = Words(
        "Stopped after {turned_deg}: the maximum lies {inside_deg} within it, and another direction has a probability "
        "of {elsewhere_percent}."
    )


@dataclass(frozen=True, slots=True)
class WholeCircleSeen:
    code: Literal["whole_circle_seen"] = "whole_circle_seen"
    english: ClassVar[Words] = Words("Stopped after the whole circle.")


@dataclass(frozen=True, slots=True)
class MaximumAtEdge:
    """edge: of the headings heard so far."""

    edge: Literal["beginning", "end"]
    by_deg: float
    code: Literal["maximum_at_edge"] = "maximum_at_edge"
    english: ClassVar[Words] = Words(
        "Turned {by_deg} further: the maximum lay at the sector's {edge?beginning=beginning|end=end}."
    )


@dataclass(frozen=True, slots=True)
class QualityPoor:
    quality: float
    by_deg: float
    code: Literal["quality_poor"] = "quality_poor"
    english: ClassVar[Words] = Words(
        "Turned {by_deg} further: what was heard resembled the antenna's pattern by {quality:2} only."
    )


@dataclass(frozen=True, slots=True)
class ElsewherePossible:
    """From what was heard and from what is believed."""

    elsewhere_percent: float
    by_deg: float
    code: Literal["elsewhere_possible"] = "elsewhere_possible"
    english: ClassVar[Words] = Words(
        "Turned {by_deg} further: a direction not yet heard had a probability of {elsewhere_percent}."
    )


@dataclass(frozen=True, slots=True)
class BearingUncertain:
    """sigma_deg: of this sweep alone."""

    sigma_deg: float
    by_deg: float
    code: Literal["bearing_uncertain"] = "bearing_uncertain"
    english: ClassVar[Words] = Words("Turned {by_deg} further: the bearing was still uncertain by {sigma_deg:1}.")


@dataclass(frozen=True, slots=True)
class NothingFoundYet:
    by_deg: float
    code: Literal["nothing_found_yet"] = "nothing_found_yet"
    english: ClassVar[Words] = Words("Turned {by_deg} further: what was heard gave no bearing yet.")


@dataclass(frozen=True, slots=True)
class TurnsHere:
    """Of a craft that never stops to turn, at a place where it does."""

    because: Literal["first", "told_nothing", "contradicts"]
    code: Literal["turns_here"] = "turns_here"
    english: ClassVar[Words] = Words(
        "It turns here: {because?first=all directions are heard once before it flies on without turning"
        "|told_nothing=the way here told little of the direction"
        "|contradicts=what it heard contradicts what was believed}."
    )


@dataclass(frozen=True, slots=True)
class WayToldEnough:
    """likelier: the emitter is at the estimate, times, than in a direction at random, as the way here heard it."""

    likelier: float
    code: Literal["way_told_enough"] = "way_told_enough"
    english: ClassVar[Words] = Words(
        "No turn here: by what was heard on the way here, the emitter is {likelier:1} times likelier at the estimate "
        "than in a direction at random."
    )


@dataclass(frozen=True, slots=True)
class NeverStopNeeds:
    """What the option of never stopping to turn asks for."""

    what: Literal["one_emitter", "carrier", "still", "joint", "swings", "rollouts"]
    code: Literal["never_stop_needs"] = "never_stop_needs"
    english: ClassVar[Words] = Words(
        "Never stopping to turn {what?one_emitter=is for one emitter: the nose swings about one direction"
        "|carrier=is for a carrier: a tag's pulses are too few on the way"
        "|still=is for an emitter that stands still"
        "|joint=needs joint bearing errors"
        "|swings=needs listening on the way and the nose's swings there"
        "|rollouts=needs the planner that simulates flights}.",
        "{what?one_emitter=Turn it off, or look for one emitter|carrier=Turn it off"
        "|still=Turn it off|joint=Choose joint errors, or turn it off"
        "|swings=Turn both on, or turn this off"
        "|rollouts=Choose that planner, or turn this off}.",
    )


StopReason = MaximumSeen | WholeCircleSeen
GoOnReason = MaximumAtEdge | QualityPoor | ElsewherePossible | BearingUncertain | NothingFoundYet
TurnReason = WholeTurn | SectorExpected | StopReason | GoOnReason | TurnsHere | WayToldEnough | NeverStopNeeds
