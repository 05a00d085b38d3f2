"""Two places compared on equal rules: the same sample paths, the same budget, and what the rules have against one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.belief.estimate import confidence_region, estimate
from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief
from planner.geometry import distance_to_convex
from planner.options import PlannerOptions
from planner.plan import expected_time_from
from planner.policy.actions import action_space, apart_from_turns, from_nearest, standoff_from, without_refused
from planner.policy.fisher import gain_beside_bias
from planner.policy.rollout import TELLING_SHARE
from planner.policy.several import Wanted, times_together
from planner.reasons import (
    BetweenPlaces,
    CrossesTooLittle,
    EchoesHeardBefore,
    NearerThanStandoff,
    RuleReason,
    TellsLittleOfBias,
)
from planner.types import Bearing, FloatArray, PlannerError, Problem

COMPARED_PATHS = 400


@dataclass(frozen=True, slots=True)
class PairedDifference:
    """mean: s by which the place takes longer than the other, negative when it is quicker. std_error: s, of pairs.

    by_claim: the planner looks one bearing ahead for a claim here, and so does the comparison.
    """

    mean: float
    std_error: float
    by_claim: bool = False


def difference_between(
    problem: Problem,
    belief: GridBelief,
    bearings: Sequence[Bearing],
    platform: tuple[float, float],
    place: tuple[float, float],
    other: tuple[float, float],
    options: PlannerOptions,
    paths: int = COMPARED_PATHS,
) -> PairedDifference:
    """By way of `place` instead of `other` (m ENU), path by path. Raises PlannerError when one cannot be reached."""
    here, there = (
        expected_time_from(problem, belief, bearings, xy, options, platform_xy=platform, rollouts=paths)
        for xy in (place, other)
    )
    if here.by_claim:
        error = 0.0 if place == other else float(np.hypot(here.std_error, there.std_error))
        return PairedDifference(here.mean - there.mean, error, by_claim=True)
    return _paired(here.times - there.times)


def difference_together(
    wanted: Sequence[Wanted],
    platform: tuple[float, float],
    place: tuple[float, float],
    other: tuple[float, float],
    options: PlannerOptions,
    paths: int = COMPARED_PATHS,
) -> PairedDifference:
    """As above by the measure in which the places for several emitters are compared: the mean of their times."""
    here, there = times_together(wanted, platform, np.array([place, other]), options, paths)
    if not (np.isfinite(here).all() and np.isfinite(there).all()):
        return PairedDifference(float("nan"), float("nan"))
    return _paired(here - there)


def _paired(differences: FloatArray) -> PairedDifference:
    return PairedDifference(float(differences.mean()), float(differences.std(ddof=1) / np.sqrt(len(differences))))


def rules_against(
    problem: Problem,
    belief: GridBelief,
    place: tuple[float, float],
    *,
    by_claim: bool = False,
    without: Sequence[tuple[float, float]] = (),
) -> tuple[RuleReason, ...]:
    """Why the rollout policy would not compare this place (m ENU); `BetweenPlaces` when nothing but the lattice does.

    by_claim: it looks one bearing ahead for a claim, and leaves out no place for telling little of the bias. without:
    places (m ENU) that the planner leaves out, since they were refused or told nothing.

    The standoff counts as far as it was kept: it shrinks where it would leave fewer than two places (6.1). So does the
    distance to earlier turns where no place is as far.
    """
    found: list[RuleReason] = []
    xy = np.array([place])
    try:
        places = without_refused(action_space(problem, belief), without, problem, belief)
    except PlannerError:
        return ()
    if len(places) == 0:
        return between_places(problem)
    away, *others = from_nearest(np.vstack([xy, places]), problem.turned_at).tolist()
    apart = apart_from_turns(np.array(others))
    if away < apart:
        found.append(EchoesHeardBefore(away, apart))
    places = places[np.array(others) >= apart]
    if problem.crossing is not None:
        if not problem.crossing.crossed_from(np.vstack([xy, places]))[0]:
            crossing, needed = np.rad2deg([problem.crossing.angles(xy)[0], problem.crossing.least])
            found.append(CrossesTooLittle(float(crossing), float(needed)))
        places = places[problem.crossing.crossed_from(places)]
    standoff = standoff_from(belief, problem)
    if standoff > 0:
        region = confidence_region(belief)
        clearances = distance_to_convex(places, region)
        kept = min(standoff, float(np.sort(clearances)[-min(2, len(clearances))]))
        clearance = float(distance_to_convex(xy, region)[0])
        if clearance < kept:
            found.append(NearerThanStandoff(clearance, kept))
        places = places[clearances >= kept]
    if not by_claim and isinstance(belief, JointBelief) and len(belief.errors) == 1:
        estimated = estimate(belief, problem.estimator)
        gains = gain_beside_bias(estimated, np.vstack([xy, places]), belief.errors[0], problem.sigma, nearest=belief.h)
        share = float(gains[0] / gains[1:].max())
        if share < TELLING_SHARE:
            found.append(TellsLittleOfBias(100.0 * share, 100.0 * TELLING_SHARE))
    return tuple(found) or between_places(problem)


def between_places(problem: Problem) -> tuple[BetweenPlaces, ...]:
    """What remains where no rule forbids a quicker place. For several emitters nothing else does: rollouts themselves
    let a bearing tell nothing where it repeats a bias or is taken too near (`planner.policy.several`)."""
    return () if problem.action_spacing is None else (BetweenPlaces(problem.action_spacing),)
