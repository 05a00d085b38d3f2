"""Likelihoods of a bearing."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.observation import (
    cuts,
    hard_likelihood,
    inside_wedge,
    mixture_likelihood,
    resolved_likelihood,
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


@pytest.mark.parametrize("cells_away", [4, 8, 20, 50])
@pytest.mark.parametrize("offset", [0.0, 0.25, 0.5])
def test_what_cells_show_of_a_wedge_has_its_mass_place_and_width(cells_away, offset):
    h = 3.0
    r, y = cells_away * h, (np.arange(-40, 41) + offset) * h
    found = resolved_likelihood(Bearing(0.0, 0.0, 0.0, SIGMA), np.full(81, r), y, h)
    mass = found / found.sum()
    assert found.sum() * h == pytest.approx(np.sqrt(2 * np.pi) * SIGMA * r, rel=0.03)
    assert mass @ y == pytest.approx(0.0, abs=0.03 * h)
    assert mass @ y**2 == pytest.approx(max(SIGMA * r, 0.5 * h) ** 2, rel=0.2)


def test_a_wedge_that_cells_show_is_that_of_their_centres():
    bearing, x, y = Bearing(0.0, 0.0, 0.0, SIGMA), np.full(5, 200.0), np.linspace(-20.0, 20.0, 5)
    centre = hard_likelihood(bearing, x, y, margin=3.0 / np.sqrt(2.0))
    assert resolved_likelihood(bearing, x, y, 3.0) == pytest.approx(centre, rel=1e-12)


def test_cells_that_the_wedge_misses_and_the_sensors_own_cell_hold_little():
    bearing = Bearing(0.0, 0.0, 0.0, SIGMA)
    found = resolved_likelihood(bearing, np.array([-10.0, 50.0, 0.0]), np.array([0.0, 40.0, 0.0]), 3.0)
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
