"""Why this place: what stands behind a policy's decision."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.options import ContinuousSelection
from planner.reason import Words


@dataclass(frozen=True, slots=True)
class QuickestPlace:
    """gain_s: how much sooner than by way of the best other place. places: how many were tried."""

    expected_time_s: float
    gain_s: float
    places: int
    code: Literal["quickest_place"] = "quickest_place"

    english: ClassVar[Words] = Words(
        "Localized in about {expected_time_s} by way of this place, "
        "{gain_s} sooner than by any other of {places} places tried."
    )


@dataclass(frozen=True, slots=True)
class LongestLead:
    """Other places came out as quick, or quicker on fewer simulated flights."""

    expected_time_s: float
    places: int
    code: Literal["longest_lead"] = "longest_lead"

    english: ClassVar[Words] = Words(
        "Localized in about {expected_time_s} by way of this place; "
        "of {places} places tried it kept its lead over the most simulated flights."
    )


@dataclass(frozen=True, slots=True)
class OnlyPlace:
    """among: whether no other place was allowed, or the budget reached for no other."""

    expected_time_s: float
    among: Literal["allowed", "tried"]
    code: Literal["only_place"] = "only_place"

    english: ClassVar[Words] = Words(
        "Localized in about {expected_time_s} by way of this place, the only one {among?allowed=allowed|tried=tried}."
    )


@dataclass(frozen=True, slots=True)
class SoonestTogether:
    """Of several emitters. mean_time_s: until each of them is localized, on average."""

    mean_time_s: float
    emitters: int
    places: int
    code: Literal["soonest_together"] = "soonest_together"

    english: ClassVar[Words] = Words(
        "By way of this place the {emitters} emitters still looked for are localized after about {mean_time_s} "
        "on average, sooner than by any other of {places|place|places} tried."
    )


@dataclass(frozen=True, slots=True)
class SoonestForFirst:
    """Of several emitters, for those that come first. first_time_s: until each of those is localized, on average, if
    each were flown for by itself from there on. others: how many more are still looked for."""

    names: tuple[str, ...]
    first_time_s: float
    others: int
    places: int
    code: Literal["soonest_for_first"] = "soonest_for_first"

    english: ClassVar[Words] = Words(
        "For {names} first: localized in about {first_time_s} by way of this place, of {places|place|places} tried. "
        "{others|other emitter decides|other emitters decide} only between places that are as good for that."
    )


@dataclass(frozen=True, slots=True)
class QuickestPlaceFound:
    """By a search over a continuous action space."""

    expected_time_s: float
    search: ContinuousSelection
    code: Literal["quickest_place_found"] = "quickest_place_found"

    english: ClassVar[Words] = Words(
        "Localized in about {expected_time_s} by way of this place, "
        "found by {search?quadrant=quadrant search|sgd=stochastic gradient descent|bfgs=BFGS}."
    )


@dataclass(frozen=True, slots=True)
class PlannedMeanwhile:
    """The specification names the dynamic program as base policy, but its table is not there yet."""

    expected_time_s: float
    places: int
    code: Literal["planned_meanwhile"] = "planned_meanwhile"

    english: ClassVar[Words] = Words(
        "Localized in about {expected_time_s} by way of this place, the best of {places|place|places} tried. "
        "Planned on the simpler base policy: the table of the dynamic program is still being computed."
    )


@dataclass(frozen=True, slots=True)
class MostInformation:
    """about: where the emitter is taken to be; at the estimate, or the worst place in the ellipse around it."""

    places: int
    about: Literal["estimate", "worst_case"]
    code: Literal["most_information"] = "most_information"

    english: ClassVar[Words] = Words(
        "A bearing from here narrows the belief most{about?estimate=|worst_case= in the worst case}, "
        "of {places|place|places} compared."
    )


@dataclass(frozen=True, slots=True)
class LeastEntropy:
    """entropy_nat: Shannon entropy of the belief expected after the next bearing."""

    entropy_nat: float
    places: int
    code: Literal["least_entropy"] = "least_entropy"

    english: ClassVar[Words] = Words(
        "The next bearing is expected to leave {entropy_nat:2} nat, the least of {places|place|places}."
    )


@dataclass(frozen=True, slots=True)
class BesideEllipse:
    """Perpendicular to the major axis of the covariance ellipse; `distance` tells the two rules for how far off."""

    distance: Literal["tabulated", "just_outside"]
    code: Literal["beside_ellipse"] = "beside_ellipse"

    english: ClassVar[Words] = Words(
        "Across the long axis of the belief, "
        "{distance?tabulated=on the nearer side|just_outside=just outside its ellipse}."
    )


RoutePlanner = Literal["sopt", "tokekar_subset", "tokekar_tree", "lookahead"]


@dataclass(frozen=True, slots=True)
class FirstOfRoute:
    """The first of several places that are planned together."""

    places: int
    planner: RoutePlanner
    code: Literal["first_of_route"] = "first_of_route"

    english: ClassVar[Words] = Words(
        "The first of {places|place|places} "
        "{planner?sopt=that would fix the near edge of the belief"
        "|tokekar_subset=that together tell most about the estimate"
        "|tokekar_tree=that hold out best against unlucky bearings"
        "|lookahead=on the course that tells most about the estimate}."
    )


ChoiceReason = (
    QuickestPlace
    | LongestLead
    | OnlyPlace
    | SoonestTogether
    | SoonestForFirst
    | QuickestPlaceFound
    | PlannedMeanwhile
    | MostInformation
    | LeastEntropy
    | BesideEllipse
    | FirstOfRoute
)
