"""Bearings from one place share its echoes, and count as one."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from planner.belief.evidence import sightings
from planner.belief.joint import JointBelief, joint_prior, update_joint
from planner.belief.same_place import OF_THE_PLACE, SAME_PLACE_M, one_a_place
from planner.belief.verdict import verdict
from planner.observation import wrap
from planner.reasons import EstimateContradicted
from planner.sweep_likelihood import at
from planner.types import Bearing, LinearMotion, LocalizationRule, Peak, Problem

SIGMA = math.radians(5.0)
SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]])
PROBLEM = Problem(area=(SQUARE,), sigma=SIGMA, threshold=10.0, measurement_time=10.0, motion=LinearMotion(5.0))
TARGET = (160.0, 170.0)
STATIONS = ((20.0, 40.0), (290.0, 60.0))


def seen(x: float, y: float, off_deg: float, source: str = "craft") -> Bearing:
    angle = math.atan2(TARGET[1] - y, TARGET[0] - x) + math.radians(off_deg)
    return Bearing(x, y, float(wrap(angle)), SIGMA, source=source)


def believed(bearings: list[Bearing]) -> JointBelief:
    belief = joint_prior(PROBLEM)
    for bearing in bearings:
        belief = update_joint(belief, bearing)
    return belief


@pytest.mark.parametrize("count", [2, 4, 9])
def test_of_what_bearings_from_one_place_have_in_common_no_number_of_them_frees_the_mean(count: int) -> None:
    combined = sightings([seen(20.0, 30.0, 6.0)] * count)
    assert len(combined.x) == 1
    wanted = SIGMA * math.sqrt(OF_THE_PLACE + (1.0 - OF_THE_PLACE) / count)
    assert float(combined.sigma[0]) == pytest.approx(wanted, rel=0.06), "an outlier's share makes it a little wider"


@pytest.mark.parametrize("sigma_deg", [1.0, 3.0])
@pytest.mark.parametrize("count", [1, 10, 300])
def test_worse_bearings_beside_a_good_one_leave_it_as_good_as_it_is(sigma_deg: float, count: int) -> None:
    good, worse = (replace(seen(20.0, 30.0, 6.0), sigma=math.radians(deg)) for deg in (sigma_deg, 5.0 * sigma_deg))
    combined = sightings([worse, good, *[worse] * (count - 1)])
    assert 0.84 * good.sigma <= float(combined.sigma[0]) <= 1.03 * good.sigma


def test_bearings_from_elsewhere_or_by_somebody_else_stay_as_they_are() -> None:
    one = replace(seen(20.0, 30.0, 6.0), peaks=(Peak(1.0, 0.3),))
    others = [seen(20.0 + SAME_PLACE_M, 30.0, 6.0), seen(20.0, 30.0, 6.0, source="ada")]
    assert one_a_place([one, *others]) == [one, *others]


def test_two_that_contradict_each_other_leave_both_directions() -> None:
    combined = sightings([seen(20.0, 30.0, 0.0), seen(21.0, 30.0, 80.0)])
    toward = math.atan2(TARGET[1] - 30.0, TARGET[0] - 20.0)
    profile, between = combined.profile[0], toward + math.radians(40.0)
    one, other = (float(at(profile, np.array(toward + math.radians(off)))) for off in (0.0, 80.0))
    assert one == pytest.approx(other, rel=0.05)
    assert one > 10.0 * float(at(profile, np.array(between)))


def test_an_echo_that_is_heard_again_and_again_is_no_emitter() -> None:
    """Three bearings from around that are right, then seven of an echo from one place (a mission of the field world
    stated 8 m where it was 111 m off)."""
    right = [seen(20.0, 40.0, 2.0), seen(290.0, 60.0, -1.0), seen(150.0, 300.0, 1.0)]
    echo = [seen(10.0, 290.0, 100.0 + off) for off in (0.0, -4.0, 2.0, 3.0, -2.0, 1.0, -3.0)]
    belief = believed([*right, *echo])
    rule = LocalizationRule(threshold=10.0)
    found = verdict(PROBLEM, rule, belief.folded, belief)
    assert found.estimate is not None
    assert math.dist((found.estimate.x, found.estimate.y), TARGET) < 15.0


RIGHT = [seen(20.0, 40.0, 2.0), seen(290.0, 60.0, -1.0), seen(150.0, 300.0, 1.0)]
RULE = LocalizationRule(threshold=10.0)


def test_an_echo_that_is_heard_again_and_again_contradicts_once() -> None:
    right = [*RIGHT, seen(290.0, 200.0, 1.0), seen(10.0, 160.0, -2.0), seen(90.0, 10.0, 1.0)]
    echo = [seen(10.0, 290.0, 100.0 + off) for off in (0.0, -4.0, 2.0, 3.0, -2.0, 1.0, -3.0)]
    for times in (1, 7):
        belief = believed([*right, *echo[:times]])
        found = verdict(PROBLEM, RULE, belief.folded, belief)
        assert len(found.against) == times
        assert found.localized


def test_one_place_outvotes_no_others_however_often_it_was_listened_from() -> None:
    wrong = [seen(150.0, 300.0, 90.0), seen(10.0, 160.0, 120.0)]
    belief = believed([*[seen(20.0, 40.0, 0.0)] * 10, seen(290.0, 60.0, 0.0), *wrong])
    reasons = verdict(PROBLEM, RULE, belief.folded, belief).reasons
    assert any(isinstance(reason, EstimateContradicted) for reason in reasons)


def test_what_most_bearings_of_a_place_say_is_what_it_says() -> None:
    """Two stations, each of which was deceived now and then."""
    station = {at: [seen(*at, off) for off in (1.0, -1.0, 90.0, 2.0, 0.0, -2.0, 140.0, 1.0)] for at in STATIONS}
    belief = believed([b for some in station.values() for b in some])
    found = verdict(PROBLEM, RULE, belief.folded, belief)
    assert len(found.against) == 4
    assert not any(isinstance(reason, EstimateContradicted) for reason in found.reasons)


def test_the_order_of_bearings_at_a_place_does_not_matter() -> None:
    there = [seen(20.0, 30.0, off) for off in (3.0, -2.0, 60.0)]
    first, second = (sightings(some) for some in (there, there[::-1]))
    assert first.profile == pytest.approx(second.profile)
