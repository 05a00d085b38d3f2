"""What the order of importance makes of several emitters' times."""

from dataclasses import replace

import numpy as np
import pytest

from planner.belief.grid import fold
from planner.options import FIELD
from planner.plan import plan
from planner.policy.importance import LESS, mean_time, weights_of
from planner.policy.several import Wanted, plan_several, times_together
from planner.reasons import SoonestForFirst, SoonestTogether
from planner.study.scenarios import scenario
from planner.types import Bearing

WORLD = scenario("field")
PROBLEM = WORLD.problem
HOME = WORLD.platform
OPTIONS = replace(FIELD, budget=400)
TARGETS = ((60.0, 60.0), (250.0, 70.0), (150.0, 110.0))


def heard(a, b):
    """Once from home, without error."""
    return fold(PROBLEM, [Bearing(*HOME, float(np.arctan2(b - HOME[1], a - HOME[0])), PROBLEM.sigma)])


def wanted(*ranks):
    return [
        Wanted(PROBLEM, heard(*target), rank, f"tag {n}")
        for n, (target, rank) in enumerate(zip(TARGETS, ranks, strict=True), start=1)
    ]


@pytest.mark.parametrize("ranks", [[0, 0, 0], [33, 33], [7]])
def test_emitters_that_are_alike_have_no_weights(ranks):
    assert weights_of(ranks) is None


def test_each_rank_weighs_less_than_the_one_before_whatever_its_numbers_and_shares_it_out():
    weights = weights_of([3, 1, 3, 33])
    assert weights is not None
    assert weights.sum() == pytest.approx(1.0)
    assert weights[1] * LESS == pytest.approx(weights[0] + weights[2])
    assert weights[0] == weights[2]
    assert weights[3] == pytest.approx(weights[1] * LESS**2)
    assert weights_of([20, 10, 20, 30]) == pytest.approx(weights, abs=0.0)


def test_the_mean_time_is_the_plain_one_of_those_alike_and_near_that_of_the_first_otherwise():
    costs = np.array([[[10.0, 20.0]], [[100.0, 100.0]]])
    assert mean_time(costs, None).tolist() == [[55.0, 60.0]]
    assert mean_time(costs, weights_of([0, 1])) == pytest.approx((costs[0] + LESS * costs[1]) / (1.0 + LESS))


@pytest.mark.parametrize("first", [0, 1, 2])
def test_the_place_is_the_firsts_to_a_few_seconds_and_never_worse_for_it_than_the_common_one(first):
    tags = wanted(*(int(number != first) for number in range(3)))
    ordered, alike = plan_several(tags, HOME, OPTIONS), plan_several(wanted(0, 0, 0), HOME, OPTIONS)
    alone = plan(PROBLEM, tags[first].belief, [None], HOME, OPTIONS)  # type: ignore[list-item]
    places = np.array([(d.x, d.y) for d in (ordered, alike, alone)])
    by_ordered, by_alike, by_alone = times_together([tags[first]], HOME, places, OPTIONS, 800).mean(axis=1)
    assert by_ordered <= by_alike + 1.0
    assert by_ordered <= by_alone + 4.0
    assert isinstance(ordered.reason, SoonestForFirst)
    assert isinstance(alike.reason, SoonestTogether)
    assert (ordered.reason.names, ordered.reason.others) == ((f"tag {first + 1}",), 2)
    assert ordered.each.shape[0] == 3
    assert ordered.reason.first_time_s == pytest.approx(ordered.each[first].mean())


def test_the_others_decide_where_nothing_differs_for_the_first():
    costs = np.array([[[40.0], [40.0]], [[90.0], [60.0]]])
    assert int(mean_time(costs, weights_of([0, 1])).argmin()) == 1


def test_what_is_equal_for_all_stays_the_decision_of_before():
    tags = wanted(5, 5, 5)
    same, before = plan_several(tags, HOME, OPTIONS), plan_several(wanted(0, 0, 0), HOME, OPTIONS)
    assert (same.x, same.y, same.rollouts) == (before.x, before.y, before.rollouts)
    assert repr(same.candidates) == repr(before.candidates)  # NaN equals nothing
