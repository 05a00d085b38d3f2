"""Why the emitter is not yet called localized (mission rule 6)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class NoBearingYet:
    """Nothing has been measured, so nothing is claimed."""

    code: Literal["no_bearing_yet"] = "no_bearing_yet"

    english: ClassVar[Words] = Words("No bearing has been taken.", "Take the first bearing.")


@dataclass(frozen=True, slots=True)
class BearingsNotInBelief:
    """bearings: that count, while the belief contains none: it is being computed, or cannot be."""

    bearings: int
    code: Literal["bearings_not_in_belief"] = "bearings_not_in_belief"

    english: ClassVar[Words] = Words(
        "The belief does not contain {bearings|bearing|bearings} yet.",
        "Wait; if it stays so, leave out the last bearing.",
    )


@dataclass(frozen=True, slots=True)
class TooFewPlaces:
    """places: distinct ones that bearings were taken from."""

    bearings: int
    places: int
    needed_places: int
    code: Literal["too_few_places"] = "too_few_places"

    english: ClassVar[Words] = Words(
        "{bearings|bearing|bearings} from {places|place|places}; {needed_places} places are needed.",
        "Take a bearing from another place.",
    )


@dataclass(frozen=True, slots=True)
class TooFewPlacesAgree:
    """agreeing_places: those of the `places` whose bearings point at the estimate."""

    agreeing_places: int
    places: int
    needed_places: int
    code: Literal["too_few_places_agree"] = "too_few_places_agree"

    english: ClassVar[Words] = Words(
        "{agreeing_places} of {places|place|places} {agreeing_places?1=agrees|*=agree} on the estimate; "
        "{needed_places} are needed.",
        "Take a bearing from another place.",
    )


@dataclass(frozen=True, slots=True)
class CrossingAngleTooSmall:
    """crossing_deg: the best crossing angle of two bearing lines at the estimate."""

    crossing_deg: float
    needed_deg: float
    code: Literal["crossing_angle_too_small"] = "crossing_angle_too_small"

    english: ClassVar[Words] = Words(
        "All bearings come from one side: they cross at only {crossing_deg}; {needed_deg} are needed.",
        "Take a bearing from another side.",
    )


@dataclass(frozen=True, slots=True)
class EstimateContradicted:
    """contradicting: bearings, of all, that do not point at the estimate."""

    contradicting: int
    bearings: int
    code: Literal["estimate_contradicted"] = "estimate_contradicted"

    english: ClassVar[Words] = Words(
        "{contradicting} of {bearings|bearing|bearings} {contradicting?1=contradicts|*=contradict} the estimate.",
        "Take another bearing.",
    )


@dataclass(frozen=True, slots=True)
class BearingsDisagree:
    """The wedges of +-4 sigma have no common point inside the area."""

    bearings: int
    code: Literal["bearings_disagree"] = "bearings_disagree"

    english: ClassVar[Words] = Words(
        "The {bearings} bearings contradict each other: at least one is an outlier.",
        "Take another bearing, or exclude the outlier.",
    )


@dataclass(frozen=True, slots=True)
class BearingMissesArea:
    """A single wedge of +-4 sigma has no point inside the area."""

    code: Literal["bearing_misses_area"] = "bearing_misses_area"

    english: ClassVar[Words] = Words(
        "The bearing points past the search area.", "Check the area, the antenna and the place of the bearing."
    )


@dataclass(frozen=True, slots=True)
class ExpectedErrorTooLarge:
    """expected_error_m: as it is stated (planner.belief.verdict.stated)."""

    expected_error_m: float
    threshold_m: float
    code: Literal["expected_error_too_large"] = "expected_error_too_large"

    english: ClassVar[Words] = Words(
        "The expected error is {expected_error_m:1}; it must fall below {threshold_m:1}.",
        "Take another bearing.",
    )


@dataclass(frozen=True, slots=True)
class ErrorMayBeFarLarger:
    """beyond_percent: probability that the emitter is further than far_m, three times the threshold, away."""

    beyond_percent: float
    most_percent: float
    far_m: float
    code: Literal["error_may_be_far_larger"] = "error_may_be_far_larger"

    english: ClassVar[Words] = Words(
        "With {beyond_percent} probability the emitter is more than {far_m} from the estimate, if bearings are wrong "
        "altogether or by the same angle; at most {most_percent} is tolerated.",
        "Take another bearing, best from the other side.",
    )


NotYetReason = (
    NoBearingYet
    | BearingsNotInBelief
    | TooFewPlaces
    | TooFewPlacesAgree
    | CrossingAngleTooSmall
    | EstimateContradicted
    | BearingsDisagree
    | BearingMissesArea
    | ExpectedErrorTooLarge
    | ErrorMayBeFarLarger
)


def disagreement(bearings: int) -> BearingsDisagree | BearingMissesArea:
    """Why the wedges of this many bearings, one or more, have no common point inside the area."""
    return BearingsDisagree(bearings) if bearings > 1 else BearingMissesArea()
