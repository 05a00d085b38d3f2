from dataclasses import replace

import numpy as np
import pytest

from planner.belief.estimate import estimate
from planner.belief.grid import prior_belief
from planner.policy.sopt import Sopt, pseudo_target, sopt
from planner.study.scenarios import scenario
from planner.types import Estimate


def groups(route):
    """Distinct places in order, and how many bearings each gets."""
    places, counts = np.unique(route, axis=0, return_counts=True)
    order = [int(np.flatnonzero((route == place).all(axis=1))[0]) for place in places]
    return places[np.argsort(order)], counts[np.argsort(order)]


def test_pseudo_target_is_the_near_edge_of_the_ellipse():
    look = Estimate(150.0, 150.0, np.diag([100.0, 1600.0]), 40.0, 5.0)
    np.testing.assert_allclose(pseudo_target(look, np.array([150.0, 0.0]), 3.0), (150.0, 30.0), atol=1e-9)
    np.testing.assert_allclose(pseudo_target(look, np.array([300.0, 150.0]), 3.0), (180.0, 150.0), atol=1e-9)


@pytest.mark.parametrize("config", ["fast", "medium", "slow"])
def test_planned_bearings_reach_the_threshold(config):
    """2 sqrt(tr J^-1) <= mu for the pseudo target, with two perpendicular lines of sight."""
    problem = scenario("2", config).problem
    belief = prior_belief(problem)
    route = sopt.route(problem, belief, (20.0, 60.0))
    places, _ = groups(route)
    information = np.zeros((2, 2))
    look = estimate(belief, "map")
    target = pseudo_target(look, np.array([20.0, 60.0]), 3.0)
    for place in route:
        x, y = target - place
        information += np.array([[y * y, -x * y], [-x * y, x * x]]) / (np.hypot(x, y) ** 4 * problem.sigma**2)
    assert 2 * np.sqrt(np.trace(np.linalg.inv(information))) == pytest.approx(problem.threshold, rel=1e-6)
    assert (target - places[0]) @ (target - places[1]) == pytest.approx(0.0, abs=1e-6)


def test_dear_bearings_are_spared_by_going_nearer():
    far = (150.0, -2000.0)
    problem = scenario("2").problem
    open_air = replace(problem, flight_area=None)
    belief = prior_belief(problem)
    quick, dear = (len(Sopt().route(replace(open_air, measurement_time=t), belief, far)) for t in (0.01, 100.0))
    assert dear < quick


def test_called_it_gives_the_first_place():
    problem = scenario("2").problem
    belief = prior_belief(problem)
    decision = sopt(problem, belief, (20.0, 60.0))
    assert (decision.x, decision.y) == tuple(sopt.route(problem, belief, (20.0, 60.0))[0])
