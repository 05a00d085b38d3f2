"""The Fisher policy is the determinant it claims to be."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.belief.estimate import estimate
from planner.belief.grid import fold
from planner.belief.joint import joint_prior, update_joint
from planner.belief.source_errors import ErrorPrior, SourceErrors, nodes
from planner.policy.actions import constrained_actions
from planner.policy.fisher import first_best, fisher, gain_beside_bias, information_gain
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


def errors_with(bias_sd, covariance_with_place):
    grid = nodes(ErrorPrior(), SIGMA, 1)
    mass = np.exp(-0.5 * (grid.bias / bias_sd) ** 2)
    return SourceErrors(
        "craft",
        2,
        ErrorPrior(),
        grid,
        mass / mass.sum(),
        np.ones(3) / 3,
        np.ones(2) / 2,
        np.array(covariance_with_place),
    )


def test_beside_a_bias_the_gain_is_what_the_place_gains_of_all_three():
    """Place and bias as one Gaussian, updated with z = dir(x) + b + w: by how much the place's determinant shrinks."""
    covariance, nearest = np.array([[30.0**2, 200.0], [200.0, 20.0**2]]), 1e-3
    errors = errors_with(np.deg2rad(4.0), (1.2, -0.6))
    whole = np.zeros((3, 3))
    whole[:2, :2], whole[:2, 2], whole[2, :2] = covariance, errors.covariance_with_place, errors.covariance_with_place
    whole[2, 2] = errors.bias_sd**2
    places = np.random.default_rng(1).uniform(-200, 200, (30, 2))
    gains = gain_beside_bias(Estimate(10.0, -5.0, covariance, 1.0, 0.0), places, errors, SIGMA, nearest)
    for (x, y), gain in zip(places, gains, strict=True):
        dx, dy = 10.0 - x, -5.0 - y
        h = np.array([-dy, dx, dx * dx + dy * dy]) / (dx * dx + dy * dy)
        after = whole - np.outer(whole @ h, h @ whole) / (h @ whole @ h + SIGMA**2)
        assert 1.0 - gain == pytest.approx(np.linalg.det(after[:2, :2]) / np.linalg.det(covariance), rel=1e-6)


def test_after_bearings_from_the_south_a_joint_belief_is_told_more_from_the_north():
    """Their bias and the distance hang together: the mirror image of a place tells what the place itself does not."""
    problem = Problem((SQUARE,), SIGMA, 10.0, 30.0, LinearMotion(5.0), standoff=40.0, action_spacing=20.0)
    belief = joint_prior(problem)
    for x in (110.0, 150.0, 190.0):
        angle = float(np.arctan2(150.0 - 20.0, 150.0 - x))
        belief = update_joint(belief, Bearing(x, 20.0, angle, np.deg2rad(2.0)))
    found = estimate(belief, "map")
    south, north = np.array([found.x, found.y - 100.0]), np.array([found.x, found.y + 100.0])
    gains = gain_beside_bias(found, np.array([south, north]), belief.errors[0], np.deg2rad(2.0), belief.h)
    assert gains[1] > gains[0]
    plain = information_gain(found, np.array([south, north]), belief.h)
    assert plain[0] == pytest.approx(plain[1], rel=1e-6)
    decision = fisher(problem, belief, (150.0, 20.0))
    assert decision.y > 60.0
