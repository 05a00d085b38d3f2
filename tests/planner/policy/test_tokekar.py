from dataclasses import replace
from itertools import combinations, product

import numpy as np
import pytest

from planner.belief.estimate import estimate
from planner.belief.grid import prior_belief
from planner.policy.information import bearing_information
from planner.policy.route import RoutePolicy
from planner.policy.tokekar import Subset, Tree, WorstCase, _ekf
from planner.study.scenarios import scenario


@pytest.fixture
def case():
    problem = scenario("2").problem
    return problem, prior_belief(problem)


def test_subset_has_the_largest_determinant_of_all(case):
    problem, belief = case
    route = Subset(bearings=2, grid=(4, 4)).route(problem, belief, (150.0, 0.0))
    look = estimate(belief, "map")
    known = np.linalg.inv(look.covariance)
    lattice = 75.0 * (np.array(list(product(range(4), range(4))), dtype=np.float64) + 0.5)
    best = max(
        np.linalg.det(
            known + bearing_information(lattice[list(c)], np.array([look.x, look.y]), problem.sigma, 1.0).sum(0)
        )
        for c in combinations(range(16), 2)
    )
    got = np.linalg.det(known + bearing_information(route, np.array([look.x, look.y]), problem.sigma, 1.0).sum(0))
    assert got == pytest.approx(best)


def test_subset_is_flown_the_short_way(case):
    problem, belief = case
    south = Subset().route(problem, belief, (150.0, 0.0))
    north = Subset().route(problem, belief, (150.0, 300.0))
    assert sorted(map(tuple, south)) == sorted(map(tuple, north))
    assert south[0, 1] <= south[-1, 1]
    assert north[0, 1] >= north[-1, 1]


def test_worst_case_keeps_off_the_ellipse_and_looks_across(case):
    problem, belief = case
    decision = WorstCase()(problem, belief, (150.0, 0.0))
    assert abs(decision.x - 150.0) > 20.0
    assert abs(decision.y - 150.0) < 30.0


def test_ekf_agrees_with_the_information_form(case):
    problem, _ = case
    covariance, place = np.array([[400.0, 30.0], [30.0, 900.0]]), np.array([20.0, 10.0])
    mean = np.array([150.0, 140.0])
    _, posterior = _ekf(mean, covariance, place, np.array(1.0), problem.sigma, 1.0)
    expected = np.linalg.inv(np.linalg.inv(covariance) + bearing_information(place, mean, problem.sigma, 1.0))
    np.testing.assert_allclose(posterior, expected)


def test_tree_finds_the_sequence_whose_worst_case_is_best(case):
    problem, belief = case
    look = estimate(belief, "map")
    start = np.array([150.0, 30.0])

    def worst(way):
        determinants = []
        for errors in product((-2.0, 0.0, 2.0), repeat=2):
            mean, covariance = np.array([look.x, look.y]), look.covariance
            for place, error in zip(way, errors, strict=True):
                mean, covariance = _ekf(mean, covariance, place, np.array(error), problem.sigma, belief.h)
            determinants.append(np.linalg.det(covariance))
        return max(determinants)

    moves = 40.0 * np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    ways = [np.array([start + a, start + a + b]) for a in moves for b in moves]
    route = Tree(depth=2, step=40.0, directions=4).route(replace(problem, flight_area=None), belief, (150.0, 30.0))
    assert worst(route) == pytest.approx(min(map(worst, ways)))
    np.testing.assert_allclose(np.hypot(*np.diff(np.vstack([start, route]), axis=0).T), 40.0)


def test_routes_are_flown_whole():
    assert isinstance(Subset(), RoutePolicy)
    assert isinstance(Tree(), RoutePolicy)
    assert not isinstance(WorstCase(), RoutePolicy)


@pytest.mark.parametrize("make", [lambda: Subset(bearings=0), lambda: Tree(depth=0), lambda: Tree(depth=7)])
def test_refuses_what_cannot_be_searched(make):
    with pytest.raises(ValueError):
        make()
