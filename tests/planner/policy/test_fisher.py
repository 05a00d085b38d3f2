"""The Fisher policy is the determinant it claims to be."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.belief.estimate import estimate
from planner.belief.grid import fold
from planner.policy.actions import constrained_actions
from planner.policy.fisher import first_best, fisher, information_gain
from planner.types import Bearing, Estimate, LinearMotion, Problem

SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]])
SIGMA = np.deg2rad(7.0)


@given(st.floats(5, 60), st.floats(5, 60), st.floats(-0.9, 0.9), st.integers(0, 1000))
def test_the_gain_ranks_places_as_the_determinant_does(sx, sy, correlation, seed):
    covariance = np.array([[sx**2, correlation * sx * sy], [correlation * sx * sy, sy**2]])
    look = Estimate(10.0, -5.0, covariance, 1.0, 0.0)
    places = np.random.default_rng(seed).uniform(-300, 300, (40, 2))
    determinants = []
    for x, y in np.array([10.0, -5.0]) - places:
        r = np.hypot(x, y)
        information = np.array([[y * y, -x * y], [-x * y, x * x]]) / (r**4 * SIGMA**2)
        determinants.append(np.linalg.det(np.linalg.inv(covariance) + information))
    gains = information_gain(look, places, nearest=1e-3)
    scaled = np.linalg.det(np.linalg.inv(covariance)) * (1 + gains / SIGMA**2)
    assert scaled == pytest.approx(np.array(determinants), rel=1e-6)


def test_it_answers_with_the_best_allowed_place():
    problem = Problem((SQUARE,), SIGMA, 10.0, 30.0, LinearMotion(5.0), standoff=40.0, action_spacing=20.0)
    belief = fold(problem, [Bearing(150.0, 0.0, 1.6, SIGMA), Bearing(0.0, 150.0, 0.2, SIGMA)])
    decision = fisher(problem, belief, (0.0, 0.0))
    places = constrained_actions(problem, belief)
    gains = information_gain(estimate(belief, "map"), places, belief.h)
    assert gains.max() == pytest.approx(
        information_gain(estimate(belief, "map"), np.array([[decision.x, decision.y]]), belief.h)[0]
    )


def test_of_equal_places_the_first_is_taken():
    assert first_best(np.array([1.0, 2.0, 2.0 * (1 + 1e-12), 1.5])) == 1
