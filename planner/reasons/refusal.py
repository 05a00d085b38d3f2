"""Why the planner refuses: there is nowhere to go, or what it was given cannot be planned with."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words
from planner.reasons.not_yet import BearingMissesArea, BearingsDisagree


@dataclass(frozen=True, slots=True)
class NoPlaceToFly:
    """Fence and no-fly areas alone leave the action space empty."""

    code: Literal["no_place_to_fly"] = "no_place_to_fly"

    english: ClassVar[Words] = Words(
        "The vehicle has nowhere to fly: the fence and the no-fly areas leave no room.", "Enlarge the fence."
    )


@dataclass(frozen=True, slots=True)
class NoPlaceInReach:
    """There are actions, but no way to any of them."""

    code: Literal["no_place_in_reach"] = "no_place_in_reach"

    english: ClassVar[Words] = Words(
        "No place can be reached from here without crossing the fence or a no-fly area.",
        "Change the fence or the no-fly areas, or start elsewhere.",
    )


@dataclass(frozen=True, slots=True)
class NoWay:
    """distance_m: to the place, in a straight line."""

    distance_m: float
    code: Literal["no_way"] = "no_way"

    english: ClassVar[Words] = Words(
        "There is no way to the place {distance_m} away without crossing the fence or a no-fly area.",
        "Choose another place.",
    )


@dataclass(frozen=True, slots=True)
class NoPlaceSeesBelief:
    """Of an entropy planner: the expected bearing leaves no mass, wherever it is taken."""

    code: Literal["no_place_sees_belief"] = "no_place_sees_belief"

    english: ClassVar[Words] = Words(
        "A bearing from any place that is allowed would miss the belief.",
        "Enlarge the fence or lower the standoff distance.",
    )


@dataclass(frozen=True, slots=True)
class EveryPlaceRefused:
    """By the operator, one after the other."""

    code: Literal["every_place_refused"] = "every_place_refused"

    english: ClassVar[Words] = Words("Every place has been refused.", "Hold, or choose the next place yourself.")


@dataclass(frozen=True, slots=True)
class TooManyPlaces:
    """spacing_m: of the action lattice. finest_m: the least spacing that gives no more than `most_places`."""

    spacing_m: float
    most_places: int
    finest_m: float
    code: Literal["too_many_places"] = "too_many_places"

    english: ClassVar[Words] = Words(
        "Places {spacing_m} apart would be more than {most_places}.", "Space them {finest_m} apart or more."
    )


@dataclass(frozen=True, slots=True)
class BudgetTooSmall:
    """rollouts: the budget. needed_rollouts: the least that the search can work with."""

    rollouts: int
    needed_rollouts: int
    code: Literal["budget_too_small"] = "budget_too_small"

    english: ClassVar[Words] = Words(
        "A budget of {rollouts|rollout|rollouts} is too small for this search.",
        "Raise it to {needed_rollouts|rollout|rollouts} or more.",
    )


@dataclass(frozen=True, slots=True)
class FixedSamplePaths:
    """paths: how many deterministic sampling has; the selection asks for more, or for new ones every time."""

    paths: int
    code: Literal["fixed_sample_paths"] = "fixed_sample_paths"

    english: ClassVar[Words] = Words(
        "This selection needs more sample paths than the {paths} of deterministic sampling.",
        "Use crn or pmc sampling.",
    )


@dataclass(frozen=True, slots=True)
class BeliefOutOfStep:
    """folded: bearings in the belief. given: bearings given beside it."""

    folded: int
    given: int
    code: Literal["belief_out_of_step"] = "belief_out_of_step"

    english: ClassVar[Words] = Words(
        "The belief holds {folded|bearing|bearings}, but {given|was|were} given.", "Fold the bearings given."
    )


@dataclass(frozen=True, slots=True)
class UnusableArea:
    """Of the search area."""

    flaw: Literal["no_ring", "too_few_corners", "not_finite", "no_extent"]
    code: Literal["unusable_area"] = "unusable_area"

    english: ClassVar[Words] = Words(
        "The search area {flaw?no_ring=is empty|too_few_corners=has fewer than three corners"
        "|not_finite=has a corner whose coordinates are not finite numbers"
        "|no_extent=covers no ground: its corners lie on one line or in one point}.",
        "Draw a polygon of at least three corners.",
    )


@dataclass(frozen=True, slots=True)
class AreaCrossesItself:
    """x_m, y_m: near the crossing, ENU."""

    x_m: float
    y_m: float
    code: Literal["area_crosses_itself"] = "area_crosses_itself"

    english: ClassVar[Words] = Words(
        "The outline of the search area crosses itself near x = {x_m:1}, y = {y_m:1}.", "Untangle it."
    )


@dataclass(frozen=True, slots=True)
class PriorOutsideArea:
    """The prior and the search area do not overlap."""

    code: Literal["prior_outside_area"] = "prior_outside_area"

    english: ClassVar[Words] = Words(
        "The prior has no mass inside the search area.", "Move the prior, or enlarge the area."
    )


@dataclass(frozen=True, slots=True)
class UnusableGaussian:
    """Of a prior or a belief."""

    code: Literal["unusable_gaussian"] = "unusable_gaussian"

    english: ClassVar[Words] = Words("A Gaussian needs a finite mean and a positive definite 2 x 2 covariance.")


@dataclass(frozen=True, slots=True)
class UnusableRing:
    """inner_m and outer_m are left out: what is not a finite number survives no JSON."""

    code: Literal["unusable_ring"] = "unusable_ring"

    english: ClassVar[Words] = Words("A ring prior needs finite radii, the inner one smaller than the outer one.")


@dataclass(frozen=True, slots=True)
class MeanAtSensor:
    """Of a Gaussian belief."""

    code: Literal["mean_at_sensor"] = "mean_at_sensor"

    english: ClassVar[Words] = Words("The mean of the belief lies at the sensor, where a bearing has no derivative.")


@dataclass(frozen=True, slots=True)
class UnusableBearing:
    """flaw: what about it cannot be used in a likelihood."""

    flaw: Literal["not_finite", "sigma", "outlier_probability", "peak", "profile"]
    code: Literal["unusable_bearing"] = "unusable_bearing"

    english: ClassVar[Words] = Words(
        "A bearing needs {flaw?not_finite=a finite place, angle and sigma|sigma=a positive sigma"
        "|outlier_probability=an outlier probability of at least 0 and below 1"
        "|peak=a finite angle and a positive weight for each further peak"
        "|profile=a finite likelihood in at least eight directions}."
    )


@dataclass(frozen=True, slots=True)
class UnusableFlights:
    """Of the flights that a movement time model is fitted to."""

    flaw: Literal["lengths_differ", "too_few", "not_finite", "equal_distances"]
    code: Literal["unusable_flights"] = "unusable_flights"

    english: ClassVar[Words] = Words(
        "A movement time model cannot be fitted: "
        "{flaw?lengths_differ=distances, turns and times are not equally many|too_few=fewer than four flights"
        "|not_finite=a distance is negative, a time is not positive, or a value is not finite"
        "|equal_distances=all flights are equally long, so speed and constant cannot be told apart}."
    )


@dataclass(frozen=True, slots=True)
class UnusableNumber:
    """given: as text, since it may be what no JSON number can be, or several numbers."""

    quantity: Literal[
        "sigma",
        "threshold",
        "measurement_time",
        "speed",
        "turn_rate",
        "acceleration",
        "movement_constant",
        "action_spacing",
        "action_grid",
        "platform_position",
        "actions",
        "budget",
        "horizon",
        "threads",
        "levels",
        "paths",
    ]
    wanted: Literal["positive", "not_negative", "at_least_one", "finite", "power_of_two"]
    given: str
    code: Literal["unusable_number"] = "unusable_number"

    english: ClassVar[Words] = Words(
        "{quantity?sigma=The bearing noise sigma|threshold=The threshold of the expected error"
        "|measurement_time=The measurement time|speed=The speed of the movement model"
        "|turn_rate=The turn rate of the movement model|acceleration=The acceleration of the movement model"
        "|movement_constant=The constant of the movement model|action_spacing=The spacing of the action lattice"
        "|action_grid=The number of cells of the action grid|platform_position=The position of the platform"
        "|actions=The number of actions|budget=The budget in rollouts|horizon=The horizon in bearings"
        "|threads=The number of threads|levels=The number of levels|paths=The number of sample paths} must be "
        "{wanted?positive=positive and finite|not_negative=finite and not negative|at_least_one=at least one"
        "|finite=finite|power_of_two=a power of two}, not {given}."
    )


RefusalReason = (
    NoPlaceToFly
    | NoPlaceInReach
    | NoWay
    | NoPlaceSeesBelief
    | EveryPlaceRefused
    | TooManyPlaces
    | BudgetTooSmall
    | FixedSamplePaths
    | BeliefOutOfStep
    | UnusableArea
    | AreaCrossesItself
    | PriorOutsideArea
    | UnusableGaussian
    | UnusableRing
    | MeanAtSensor
    | UnusableBearing
    | UnusableFlights
    | UnusableNumber
    | BearingsDisagree
    | BearingMissesArea
)
"""What a `PlannerError` carries; the last two are those of `InconsistentBearings`."""
