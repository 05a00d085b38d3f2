"""Likelihoods of a bearing."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.observation import (
    cuts,
    gaussian_likelihood,
    hard_likelihood,
    inside_wedge,
    mean_likelihood,
    mixture_likelihood,
    wrap,
)
from planner.types import Bearing, Peak

SIGMA = np.deg2rad(4.0)


@given(st.floats(-50, 50))
def test_wrapping_keeps_the_direction(angle):
    assert -np.pi <= wrap(angle) < np.pi
    assert np.cos(wrap(angle)) == pytest.approx(np.cos(angle), abs=1e-9)


@given(st.floats(-np.pi, np.pi), st.floats(-3.9, 3.9))
def test_inside_the_wedge_the_likelihood_is_gaussian_across_the_wrap(angle, sigmas):
    bearing = Bearing(3.0, -2.0, angle, SIGMA)
    x, y = 3.0 + 80 * np.cos(angle + sigmas * SIGMA), -2.0 + 80 * np.sin(angle + sigmas * SIGMA)
    value = hard_likelihood(bearing, np.array([x]), np.array([y]), margin=1.0)
    assert value[0] == pytest.approx(np.exp(-0.5 * sigmas**2), rel=1e-6)


def test_outside_the_widened_wedge_nothing_and_in_its_margin_the_edge():
    bearing = Bearing(0.0, 0.0, 0.0, SIGMA)
    x = np.full(3, 100.0)
    edge = 100.0 * np.tan(4 * SIGMA)
    y = np.array([edge - 0.1, edge + 1.0, edge + 5.0])
    values = hard_likelihood(bearing, x, y, margin=2.0)
    assert values[1] == pytest.approx(np.exp(-8.0))
    assert values[0] > values[1]
    assert values[2] == 0.0
    assert not inside_wedge(bearing, np.array([-10.0]), np.array([0.0]), margin=2.0)[0]


@pytest.mark.parametrize(("r", "good_to"), [(4.0, 0.3), (8.0, 0.15), (15.0, 0.05), (40.0, 0.01), (150.0, 0.01)])
def test_the_mean_over_a_cell_is_that_of_its_points(r, good_to):
    h, off = 3.0, (np.arange(60) + 0.5) / 60 - 0.5
    for sigmas in (0.0, 1.0, 2.0):
        angle = 0.3 + sigmas * SIGMA
        x, y = r * np.cos(angle), r * np.sin(angle)
        px, py = (x + h * off)[None, :], (y + h * off)[:, None]
        exact = float(gaussian_likelihood(np.arctan2(py, px) - 0.3, SIGMA).mean())
        found = float(mean_likelihood(Bearing(0.0, 0.0, 0.3, SIGMA), np.array([x]), np.array([y]), h)[0])
        assert found == pytest.approx(exact, rel=good_to)


def test_far_from_the_sensor_and_on_a_fine_grid_the_mean_is_the_centres():
    bearing, x, y = Bearing(0.0, 0.0, 0.0, SIGMA), np.full(5, 200.0), np.linspace(-20.0, 20.0, 5)
    centre = hard_likelihood(bearing, x, y, margin=0.1 / np.sqrt(2.0))
    assert mean_likelihood(bearing, x, y, 0.1) == pytest.approx(centre, rel=1e-4)


def test_cells_that_the_wedge_misses_and_the_sensors_own_cell_hold_little():
    bearing = Bearing(0.0, 0.0, 0.0, SIGMA)
    found = mean_likelihood(bearing, np.array([-10.0, 50.0, 0.0]), np.array([0.0, 40.0, 0.0]), 3.0)
    assert (found[:2] == 0.0).all()
    assert 0.0 < found[2] < 0.2


HERE = (np.array(100.0), np.array(20.0))


@given(st.floats(0.0, 0.5), st.floats(0.1, 1.0))
def test_a_mixture_integrates_to_one_over_the_bearing(eps, weight):
    angles = np.linspace(-np.pi, np.pi, 20_001)[:-1]
    values = [
        mixture_likelihood(Bearing(0.0, 0.0, float(z), SIGMA, eps, (Peak(float(z) + 1.5, weight),)), *HERE)
        for z in angles[::50]
    ]
    assert np.mean(values) * 2 * np.pi == pytest.approx(1.0, rel=1e-3)


def test_only_honest_and_narrow_bearings_cut():
    assert cuts(Bearing(0, 0, 0, SIGMA))
    assert not cuts(Bearing(0, 0, 0, SIGMA, outlier_probability=0.1))
    assert not cuts(Bearing(0, 0, 0, SIGMA, peaks=(Peak(1.0, 0.5),)))
    assert not cuts(Bearing(0, 0, 0, np.deg2rad(30.0)))
