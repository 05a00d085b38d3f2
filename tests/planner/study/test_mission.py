from dataclasses import replace

import numpy as np
import pytest

from planner.policy.ellipse import ellipse
from planner.policy.route import RoutePolicy
from planner.policy.sopt import sopt
from planner.policy.vander_hook import vander_hook
from planner.study.mission import fly, opening
from planner.study.scenarios import scenario


@pytest.fixture
def case():
    return scenario("2")


@pytest.mark.parametrize("policy", [ellipse, vander_hook, sopt])
def test_time_is_travel_and_bearings(case, policy):
    start = opening(case, policy, repeatable=True)
    for run in range(5):
        mission = fly(case, policy, start, run, seed=1)
        assert mission.time == pytest.approx(mission.travel / 5.0 + 10.0 * mission.bearings)
        assert mission.localized
        assert mission.expected_rmse < case.problem.threshold


def test_all_policies_meet_the_same_luck(case):
    one, other = (fly(case, policy, opening(case, policy, repeatable=True), 3, seed=1) for policy in (ellipse, sopt))
    assert (one.target_x, one.target_y) == (other.target_x, other.target_y)


def test_a_kept_opening_changes_nothing(case):
    kept, asked = (opening(case, ellipse, repeatable=repeatable) for repeatable in (True, False))
    assert kept.decision is not None
    assert asked.decision is None
    assert fly(case, ellipse, kept, 4, seed=1) == fly(case, ellipse, asked, 4, seed=1)


def test_the_first_bearing_of_scenario_1_costs_its_time_only():
    case = scenario("1")
    seen = []

    def spy(problem, belief, platform, rng):
        seen.append((belief.bearings, platform))
        return ellipse(problem, belief, platform, rng)

    fly(case, spy, opening(case, spy, repeatable=False), 5, seed=1)
    assert seen[0] == (1, (150.0, 0.0))


def test_routes_are_flown_whole_before_the_planner_is_asked_again(case):
    asked = []

    class Two(RoutePolicy):
        def route(self, problem, belief, platform):
            asked.append(belief.bearings)
            return np.array([[20.0, 20.0], [280.0, 20.0]])

        def __call__(self, problem, belief, platform, rng=None):
            raise AssertionError

    fly(
        replace(case, problem=replace(case.problem, threshold=8.0)), Two(), opening(case, Two(), repeatable=False), 0, 1
    )
    assert asked == list(range(0, 2 * len(asked), 2))


def test_a_planner_that_never_localizes_is_stopped(case):
    def stay(problem, belief, platform, rng):
        return replace(ellipse(problem, belief, platform, rng), x=150.0, y=0.0)

    mission = fly(case, stay, opening(case, stay, repeatable=False), 0, seed=1)
    assert not mission.localized
    assert mission.bearings == 100
