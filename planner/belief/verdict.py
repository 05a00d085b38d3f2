"""When "localized" may be said (design, mission rule 6): never from one place, never from bearings that disagree."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from planner.belief.estimate import estimate, mass_within, radius_of
from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief, corrected
from planner.belief.moving import MovingBelief, corrected_moving, where_it_may_be
from planner.belief.same_place import by_place
from planner.belief.seen_on_the_way import SeenFrom, seen_on_the_way
from planner.crossing import Crossing
from planner.geometry import clip_wedge, validate_area
from planner.observation import WEDGE_SIGMAS, WIDEST_HARD_WEDGE, expected_bearing, wrap
from planner.reasons import (
    CrossingAngleTooSmall,
    ErrorMayBeFarLarger,
    EstimateContradicted,
    ExpectedErrorTooLarge,
    NoBearingYet,
    NotYetReason,
    TooFewPlaces,
    TooFewPlacesAgree,
    disagreement,
)
from planner.types import Bearing, Estimate, FloatArray, LocalizationRule, Problem, Region, Verdict

FAR_ERRORS = 3.0
"""Times what is stated."""
MOST_BEYOND = 0.02
"""Probability that the error is larger than three times the goal, of a joint belief. Twice what outliers at their usual
rate leave of a belief of a few bearings, so that it only stops what is not yet settled."""
WITHIN_A_CELL = (math.sqrt(2.0) + math.asinh(1.0)) / 6.0
"""Mean distance of a square's points from its centre, over its side."""
LINE = math.sqrt(math.pi / 2.0)
"""The standard deviation of a normal distribution along a line, over its mean distance."""

TELLING_SIGMA = np.deg2rad(25.0)
"""An emitter that moves: an older bearing, by now less sure than this, is no place that the claim rests on."""


def verdict(
    problem: Problem, rule: LocalizationRule, bearings: Sequence[Bearing], belief: GridBelief | None
) -> Verdict:
    """Localized, or why not yet. belief: None when the bearings are inconsistent.

    With a joint belief the bearings are judged as it reads them, freed of the bias of their source.
    Only bearings that point at the estimate count for places and crossing angle: a rejected outlier proves nothing. Of
    legs, where the rule has them, only those that speak for it; those that speak against it contradict as bearings do.
    The estimate's expected error is the stated one, which may reach the goal where the one that is judged is below it.
    """
    if belief is None:
        return Verdict(False, False, (disagreement(len(bearings)),))
    mean = estimate(belief, problem.estimator)
    spread = stated(belief, mean, rule.threshold)
    area = where_it_may_be(belief) if isinstance(belief, MovingBelief) else problem.area
    bearings = _as_read(belief, bearings, spread)
    consistent = wedges_meet(area, bearings)
    if not bearings:
        return Verdict(False, consistent, (NoBearingYet(),), spread)
    against = tuple(i for i, b in enumerate(bearings) if not points_at(b, spread.x, spread.y))
    supporting, ways = _supporting(belief, bearings, spread), _ways(rule, belief, spread)
    seen = [*supporting, *(_line(one, spread) for one in ways if one.sees)]
    said = [*bearings, *(_line(one, spread) for one in ways if one.sees or one.against)]
    against_it = len(against) + sum(one.against for one in ways)
    reasons: list[NotYetReason] = [
        *_place_reasons(rule, said, seen),
        *_angle_reasons(rule, seen, spread.x, spread.y),
    ]
    if _outvoted(belief, bearings, spread, ways):
        reasons.append(EstimateContradicted(against_it, len(said)))
    elif not wedges_meet(area, _towards(supporting, spread)):
        reasons.append(disagreement(len(supporting)))
    if not _judged(belief, mean) < rule.threshold:
        reasons.append(_error_reason(belief, mean, spread, rule))
    return Verdict(not reasons, consistent, tuple(reasons), spread, against, tuple((w.leg, w.said) for w in ways))


def missing_crossing(
    problem: Problem, rule: LocalizationRule, bearings: Sequence[Bearing], belief: GridBelief
) -> Crossing | None:
    """What the next bearing must cross; None where the error is still too large, or the lines cross widely enough."""
    mean = estimate(belief, problem.estimator)
    supporting = _supporting(belief, _as_read(belief, bearings, mean), mean)
    supporting += [_line(one, mean) for one in _ways(rule, belief, mean) if one.sees]
    if not _judged(belief, mean) < rule.threshold or not _angle_reasons(rule, supporting, mean.x, mean.y):
        return None
    directions = [float(expected_bearing(b.x, b.y, mean.x, mean.y)) for b in supporting]
    return Crossing(mean.x, mean.y, np.array(directions), rule.min_crossing_angle)


def _as_read(belief: GridBelief, bearings: Sequence[Bearing], spread: Estimate) -> Sequence[Bearing]:
    if isinstance(belief, MovingBelief):
        return corrected_moving(belief, bearings, spread.x, spread.y)
    return corrected(belief, bearings)


def _supporting(belief: GridBelief, bearings: Sequence[Bearing], spread: Estimate) -> list[Bearing]:
    return [b for b in bearings if points_at(b, spread.x, spread.y) and _tells(belief, b)]


def _outvoted(belief: GridBelief, bearings: Sequence[Bearing], spread: Estimate, ways: Sequence[SeenFrom]) -> bool:
    """Whether fewer than three speak for the estimate, or not twice as many as speak against it. To a joint belief the
    bearings from one place are one, which speaks as most of them do: an echo is heard as often as one listens there."""
    places = by_place(bearings) if isinstance(belief, JointBelief) else [[bearing] for bearing in bearings]
    seeing = [[points_at(b, spread.x, spread.y) for b in there] for there in places]
    telling = sum(
        2 * sum(see) >= len(see) and _tells(belief, there[0]) for see, there in zip(seeing, places, strict=True)
    )
    against = sum(2 * sum(see) <= len(see) for see in seeing)
    for one in ways:
        telling, against = telling + one.sees, against + one.against
    return telling < max(3, 2 * against) and against > 0


def _ways(rule: LocalizationRule, belief: GridBelief, spread: Estimate) -> tuple[SeenFrom, ...]:
    """Legs that may count as places."""
    return seen_on_the_way(belief, spread.x, spread.y) if rule.ways else ()


def _line(seen: SeenFrom, spread: Estimate) -> Bearing:
    """From the middle of a leg to the estimate, of which it speaks."""
    angle = float(expected_bearing(seen.x, seen.y, spread.x, spread.y))
    return Bearing(seen.x, seen.y, angle, TELLING_SIGMA)


def _towards(supporting: Sequence[Bearing], spread: Estimate) -> list[Bearing]:
    """Those whose main peak supports: the main peak of another is not where the belief takes it to come from."""
    return [b for b in supporting if points_at(replace(b, peaks=()), spread.x, spread.y)]


def _tells(belief: GridBelief, bearing: Bearing) -> bool:
    """Whether a bearing, as the belief reads it, says anything of where the emitter is now."""
    return not isinstance(belief, MovingBelief) or bearing.sigma <= TELLING_SIGMA


def stated(belief: GridBelief, mean: Estimate, goal: float) -> Estimate:
    """The estimate with the error that may be stated; goal: m, what a claim asks for.

    Three times as far is where an emitter is looked for, and of a line 1.6 % lies beyond three mean distances. So a
    joint belief states the standard deviation of the line with its mean distance, beyond three of which lies at most
    0.3 % of a normal distribution, as far as the goal allows:

        max(E|x - e|, r_0.98 / 3, min(goal, sqrt(pi / 2) E|x - e|))
    """
    error = _judged(belief, mean)
    if isinstance(belief, JointBelief | MovingBelief):
        error = max(error, min(goal, LINE * mean.expected_rmse))
    return replace(mean, expected_rmse=error)


def _judged(belief: GridBelief, mean: Estimate) -> float:
    """m, the error that a claim is judged by: the mean distance, of a joint belief at least a third of the radius that
    leaves MOST_BEYOND outside, and that of a cell's points from its centre.

    Of a posterior with a heavy tail (few bearings, each perhaps wrong) the mean distance says too little.
    """
    if not isinstance(belief, JointBelief | MovingBelief):
        return mean.expected_rmse
    error = max(mean.expected_rmse, WITHIN_A_CELL * belief.h)
    if _beyond(belief, mean, error) <= MOST_BEYOND:
        return error
    return max(error, radius_of(belief, mean.x, mean.y, 1.0 - MOST_BEYOND) / FAR_ERRORS)


def _beyond(belief: GridBelief, at: Estimate, error: float) -> float:
    """Probability that the emitter is further than three times `error` m away."""
    return 1.0 - mass_within(belief, at.x, at.y, FAR_ERRORS * error)


def _error_reason(belief: GridBelief, mean: Estimate, spread: Estimate, rule: LocalizationRule) -> NotYetReason:
    """Whether the mean distance is too large, or the tail alone. spread: the same with the error that is stated."""
    if mean.expected_rmse >= rule.threshold:
        return ExpectedErrorTooLarge(spread.expected_rmse, rule.threshold)
    beyond = _beyond(belief, mean, rule.threshold)
    return ErrorMayBeFarLarger(100.0 * beyond, 100.0 * MOST_BEYOND, FAR_ERRORS * rule.threshold)


def wedges_meet(area: Region, bearings: Sequence[Bearing]) -> bool:
    """Whether the +-4 sigma wedges of all bearings (main peaks) have a common point inside the area.

    Wedges too wide to cut (half angle above 80 deg) never contradict.
    """
    remaining: Region = validate_area(area)
    for bearing in bearings:
        half = WEDGE_SIGMAS * bearing.sigma
        if half > WIDEST_HARD_WEDGE:
            continue
        clipped = (clip_wedge(ring, bearing.x, bearing.y, bearing.angle, half) for ring in remaining)
        remaining = tuple(ring for ring in clipped if len(ring) > 0)
        if not remaining:
            return False
    return True


def points_at(bearing: Bearing, x: float, y: float) -> bool:
    """Whether any peak of the bearing sees (x, y) within 4 sigma."""
    direction = expected_bearing(bearing.x, bearing.y, x, y)
    angles = np.array([bearing.angle, *(peak.angle for peak in bearing.peaks)])
    return bool((np.abs(wrap(angles - direction)) <= WEDGE_SIGMAS * bearing.sigma).any())


def best_crossing_angle(bearings: Sequence[Bearing], x: float, y: float) -> float:
    """Largest angle, rad in [0, pi/2], between the lines from any two bearings' places to (x, y)."""
    directions: FloatArray = np.array([expected_bearing(b.x, b.y, x, y) for b in bearings])
    if len(directions) < 2:
        return 0.0
    between = np.abs(wrap(directions[:, None] - directions))
    return float(np.minimum(between, np.pi - between).max())


def distinct_places(bearings: Sequence[Bearing], distance: float) -> int:
    """How many places at least `distance` m apart the bearings were taken from, counted in their order."""
    places: list[tuple[float, float]] = []
    for b in bearings:
        if all(np.hypot(b.x - x, b.y - y) >= distance for x, y in places):
            places.append((b.x, b.y))
    return len(places)


def _place_reasons(
    rule: LocalizationRule, bearings: Sequence[Bearing], supporting: Sequence[Bearing]
) -> list[NotYetReason]:
    taken, agreeing = (distinct_places(some, rule.min_place_distance) for some in (bearings, supporting))
    if agreeing >= rule.min_places:
        return []
    if taken > agreeing:
        return [TooFewPlacesAgree(agreeing, taken, rule.min_places)]
    return [TooFewPlaces(len(bearings), taken, rule.min_places)]


def _angle_reasons(rule: LocalizationRule, supporting: Sequence[Bearing], x: float, y: float) -> list[NotYetReason]:
    if distinct_places(supporting, rule.min_place_distance) < 2:
        return []
    angle = best_crossing_angle(supporting, x, y)
    if angle >= rule.min_crossing_angle:
        return []
    return [CrossingAngleTooSmall(float(np.rad2deg(angle)), float(np.rad2deg(rule.min_crossing_angle)))]
