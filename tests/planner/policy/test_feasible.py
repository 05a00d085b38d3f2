from dataclasses import replace

import numpy as np
import pytest
from refusals import refusing

from planner.belief.estimate import confidence_region
from planner.belief.grid import prior_belief
from planner.geometry import distance_to_convex
from planner.policy.feasible import nearest_feasible
from planner.reasons import NoPlaceToFly
from planner.study.scenarios import scenario

HOLE = np.array([[190.0, 100.0], [260.0, 100.0], [260.0, 200.0], [190.0, 200.0]])


@pytest.fixture
def case():
    problem = scenario("2").problem
    return problem, prior_belief(problem)


def test_an_allowed_place_stays_where_it_is(case):
    problem, belief = case
    np.testing.assert_array_equal(nearest_feasible(problem, belief, np.array([33.3, 77.7])), (33.3, 77.7))


def test_a_place_in_a_no_fly_area_moves_out_by_no_more_than_it_must(case):
    problem, belief = case
    x, y = nearest_feasible(replace(problem, no_fly=(HOLE,)), belief, np.array([200.0, 150.0]))
    assert x < 190.0
    assert np.hypot(x - 200.0, y - 150.0) < 10.0 + 15.0 * np.sqrt(2)


def test_the_standoff_is_kept(case):
    problem, belief = case
    place = nearest_feasible(replace(problem, standoff=50.0), belief, np.array([150.0, 150.0]))
    assert distance_to_convex(place[None], confidence_region(belief))[0] >= 50.0


def test_no_place_at_all_is_an_error(case):
    problem, belief = case
    everywhere = np.array([[-10.0, -10.0], [310.0, -10.0], [310.0, 310.0], [-10.0, 310.0]])
    with refusing(NoPlaceToFly()):
        nearest_feasible(replace(problem, no_fly=(everywhere,)), belief, np.array([150.0, 150.0]))
