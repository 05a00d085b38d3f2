"""Fisher information of bearings and of what is known."""

import numpy as np

from planner.policy.information import bearing_gradient, bearing_information, prior_information
from planner.types import Estimate


def test_information_of_a_bearing():
    (j,) = bearing_information(np.array([[10.0, 20.0]]), np.array([13.0, 24.0]), 0.1, nearest=1.0)
    np.testing.assert_allclose(j, np.array([[16.0, -12.0], [-12.0, 9.0]]) / (625 * 0.01))


def test_a_nearer_target_counts_as_the_nearest():
    place, direction = np.array([10.0, 20.0]), np.array([0.6, 0.8])
    near = bearing_information(place, place + 0.5 * direction, 0.1, nearest=2.0)
    on_the_edge = bearing_information(place, place + 2.0 * direction, 0.1, nearest=2.0)
    np.testing.assert_allclose(near, on_the_edge / 16.0)


def test_the_gradient_is_that_of_the_bearing():
    target, step = np.array([[3.0, -2.0]]), 1e-6
    moved = target + step * np.eye(2)
    differences = (np.arctan2(moved[:, 1], moved[:, 0]) - np.arctan2(-2.0, 3.0)) / step
    np.testing.assert_allclose(bearing_gradient(target, np.array([13.0]))[0], differences, rtol=1e-5)


def test_a_belief_without_width_has_finite_information():
    narrow = Estimate(0.0, 0.0, np.diag([4.0, 0.0]), expected_rmse=1.0, entropy=0.0)
    known = prior_information(narrow)
    assert np.isfinite(known).all()
    np.testing.assert_allclose(known[0, 0], 0.25, rtol=1e-6)
