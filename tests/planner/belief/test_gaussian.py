"""The iterated EKF against what a textbook says of it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refusing
from scipy.optimize import minimize

from planner.belief.gaussian import GaussianBelief, update
from planner.reasons import MeanAtSensor, UnusableGaussian
from planner.types import Bearing

SIGMA = np.deg2rad(4.0)


def test_far_away_it_is_the_linear_kalman_filter():
    """At 10 km the bearing is a position across the line of sight with variance (r sigma)^2."""
    belief = GaussianBelief(np.array([0.0, 0.0]), np.diag([400.0, 900.0]))
    sigma = 1e-3
    after = update(belief, Bearing(-10_000.0, 0.0, 1e-3, sigma))
    measured, variance = 10.0, (10_000.0 * sigma) ** 2
    gain = 900.0 / (900.0 + variance)
    assert after.mean == pytest.approx([0.0, gain * measured], abs=0.05)
    assert np.diag(after.covariance) == pytest.approx([400.0, (1 - gain) * 900.0], rel=1e-2)


@given(st.floats(-40, 40), st.floats(60, 200), st.floats(-2, 2))
def test_the_iterate_is_the_mode_of_the_posterior(x, y, error):
    """Bell and Cathey (1993): the iterated EKF is Gauss-Newton on the posterior's negative logarithm."""
    mean, covariance = np.array([0.0, 100.0]), np.array([[100.0, 20.0], [20.0, 225.0]])
    angle = np.arctan2(mean[1], mean[0] - x) + error * SIGMA
    bearing = Bearing(x, 0.0, float(angle), SIGMA)
    inverse = np.linalg.inv(covariance)

    def negative_log(p):
        off = p - mean
        residual = (angle - np.arctan2(p[1], p[0] - x) + np.pi) % (2 * np.pi) - np.pi
        return 0.5 * off @ inverse @ off + 0.5 * (residual / SIGMA) ** 2

    after = update(GaussianBelief(mean, covariance), bearing)
    mode = minimize(negative_log, after.mean, tol=1e-12).x
    assert negative_log(after.mean) <= negative_log(mode) + 1e-6


@given(st.floats(-3, 3), st.floats(-100, 100))
def test_a_bearing_never_adds_uncertainty(error, x):
    belief = GaussianBelief(np.array([0.0, 100.0]), np.diag([100.0, 400.0]))
    after = update(belief, Bearing(x, 0.0, float(np.arctan2(100.0, -x) + error * SIGMA), SIGMA))
    assert np.linalg.eigvalsh(belief.covariance - after.covariance)[0] >= -1e-9
    assert np.linalg.eigvalsh(after.covariance)[0] > 0


def test_it_measures_across_not_along_the_line_of_sight():
    belief = GaussianBelief(np.array([0.0, 100.0]), np.diag([100.0, 100.0]))
    after = update(belief, Bearing(0.0, 0.0, np.pi / 2, SIGMA))
    assert after.covariance[1, 1] == pytest.approx(100.0)
    assert after.covariance[0, 0] == pytest.approx(1 / (1 / 100.0 + 1 / (100.0 * SIGMA) ** 2))


def test_unusable_beliefs_and_places_are_refused():
    with refusing(UnusableGaussian()):
        GaussianBelief(np.zeros(2), np.zeros((2, 2)))
    with refusing(UnusableGaussian()):
        GaussianBelief(np.array([np.nan, 0.0]), np.eye(2))
    with refusing(MeanAtSensor()):
        update(GaussianBelief(np.zeros(2), np.eye(2)), Bearing(0.0, 0.0, 1.0, SIGMA))
