"""A leg is a place that a claim may rest on where it speaks for the estimate, and a contradiction where against it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from planner.belief.joint import JointBelief, heard_on_the_way, joint_prior, update_joint
from planner.belief.seen_on_the_way import TELLS, seen_on_the_way
from planner.belief.verdict import missing_crossing, verdict
from planner.on_the_way import Stretch
from planner.reasons import EstimateContradicted, NoBearingYet, TooFewPlaces
from planner.types import Bearing, LinearMotion, LocalizationRule, Problem

AHEAD = tuple((-np.minimum(12.0 * (((np.arange(36) + 18) % 36 - 18) / 6.5) ** 2, 15.0)).tolist())
SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]])
SIGMA = math.radians(4.0)
PROBLEM = Problem(area=(SQUARE,), sigma=SIGMA, threshold=25.0, measurement_time=10.0, motion=LinearMotion(5.0))
WAYS = LocalizationRule(threshold=25.0, ways=True)
TARGET = (160.0, 170.0)
CRAFT = "craft"


def heard_along(
    begin: tuple[float, float],
    end: tuple[float, float],
    emitter: tuple[float, float] = TARGET,
    leg: str = "leg",
    source: str = CRAFT,
) -> tuple[Stretch, ...]:
    """Stretches of 20 m; the antenna swings by 75 degrees to either side of where the emitter is taken to be."""
    length = math.dist(begin, end)
    told: list[Stretch] = []
    for k in range(int(length / 20.0)):
        share = (20.0 * k + np.linspace(0.0, 20.0, 14)) / length
        x, y = begin[0] + share * (end[0] - begin[0]), begin[1] + share * (end[1] - begin[1])
        middle = math.atan2(TARGET[1] - y.mean(), TARGET[0] - x.mean())
        front = middle + np.radians(np.linspace(-75.0, 75.0, 14)) * (-1.0) ** k
        off_x, off_y = emitter[0] - x, emitter[1] - y
        relative = (np.arctan2(off_y, off_x) - front) / (2.0 * np.pi) % 1.0
        gain = np.interp(relative, np.arange(36) / 36, AHEAD, period=1.0)
        power = -40.0 + gain - 20.0 * np.log10(np.hypot(off_x, off_y))
        told.append(Stretch(source, tuple(x), tuple(y), tuple(front), tuple(power), AHEAD, SIGMA, leg))
    return tuple(told)


def toward(x: float, y: float) -> Bearing:
    return Bearing(x, y, math.atan2(TARGET[1] - y, TARGET[0] - x), SIGMA, source=CRAFT)


def believing(*stretches: Stretch, bearings: tuple[Bearing, ...] = (toward(160.0, 20.0),)) -> JointBelief:
    belief = joint_prior(PROBLEM)
    for bearing in bearings:
        belief = update_joint(belief, bearing)
    return heard_on_the_way(belief, stretches) if stretches else belief


ALONG = heard_along((20.0, 60.0), (20.0, 180.0))


def test_a_leg_speaks_for_the_place_that_it_heard_and_against_others() -> None:
    belief = believing(*ALONG)
    (here,) = seen_on_the_way(belief, *TARGET)
    assert here.sees
    assert not here.against
    assert (here.x, here.y) == pytest.approx((20.0, 120.0), abs=0.1), "one place, in its middle"
    (other,) = seen_on_the_way(belief, 160.0, 20.0)
    assert other.said < -TELLS
    assert other.against


def test_it_says_nothing_of_places_beside_its_way() -> None:
    (beside,) = seen_on_the_way(believing(*heard_along((20.0, 100.0), (20.0, 140.0))), 30.0, 120.0)
    assert beside.said == 0.0


def test_each_leg_is_a_place_of_its_own() -> None:
    another = heard_along((60.0, 280.0), (180.0, 280.0), leg="other")
    assert len(seen_on_the_way(believing(*ALONG, *another), *TARGET)) == 2


def test_legs_of_a_craft_that_has_not_turned_are_no_places() -> None:
    stretches = heard_along((20.0, 60.0), (20.0, 180.0), source="another")
    assert seen_on_the_way(believing(*stretches), *TARGET) == ()


def test_a_claim_may_rest_on_one_turn_and_the_ways_flown_since_where_the_rule_says_so() -> None:
    bearings = (toward(160.0, 20.0),)
    belief = believing(*ALONG, *heard_along((60.0, 280.0), (180.0, 280.0), leg="other"), bearings=bearings)
    assert not any(isinstance(one, TooFewPlaces) for one in verdict(PROBLEM, WAYS, bearings, belief).reasons)
    without = verdict(PROBLEM, replace(WAYS, ways=False), bearings, belief)
    assert TooFewPlaces(1, 1, 2) in without.reasons
    assert not without.localized


def test_lines_from_legs_must_cross_like_any_others() -> None:
    """From south of the emitter, all of them."""
    bearings = (toward(160.0, 20.0),)
    belief = believing(*heard_along((140.0, 40.0), (180.0, 40.0)), bearings=bearings)
    missing = missing_crossing(replace(PROBLEM, threshold=1e3), replace(WAYS, threshold=1e3), bearings, belief)
    assert missing is not None
    assert len(missing.directions) == 2


def test_a_leg_that_heard_it_elsewhere_contradicts_until_it_is_outvoted() -> None:
    far_off = heard_along((20.0, 100.0), (20.0, 140.0), emitter=(40.0, 290.0))
    two = (toward(160.0, 20.0), toward(300.0, 170.0))
    answer = verdict(PROBLEM, WAYS, two, believing(*far_off, bearings=two))
    assert any(isinstance(one, EstimateContradicted) for one in answer.reasons)
    three = (*two, toward(260.0, 40.0))
    answer = verdict(PROBLEM, WAYS, three, believing(*far_off, bearings=three))
    assert not any(isinstance(one, EstimateContradicted) for one in answer.reasons)
    assert answer.against == (), "no bearing is accused"
    ((name, said),) = answer.ways
    assert name == "leg"
    assert said <= -TELLS


def test_without_any_turn_nothing_is_claimed() -> None:
    belief = believing(*ALONG, bearings=())
    assert verdict(PROBLEM, WAYS, (), belief).reasons == (NoBearingYet(),)
