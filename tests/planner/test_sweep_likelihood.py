"""A sweep's likelihood over direction as a density: a normal one is the bearing and sigma that say the same."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.sweep_likelihood import EXCLUDED, at, density, scaled, width

ANGLE = 2.0 * math.pi * np.arange(360) / 360
NO_LESS = math.radians(1.0)


def normal(angle: float, sigma_deg: float) -> tuple[float, ...]:
    off = np.angle(np.exp(1j * (ANGLE - angle)))
    return tuple((-0.5 * (off / math.radians(sigma_deg)) ** 2).tolist())


@given(angle=st.floats(-math.pi, math.pi), sigma_deg=st.floats(2.0, 20.0), scale=st.floats(0.7, 1.6))
def test_a_normal_one_is_normal_and_its_scale_that_of_sigma(angle: float, sigma_deg: float, scale: float) -> None:
    found = density(normal(angle, sigma_deg), NO_LESS)
    assert width(found) == pytest.approx(math.radians(sigma_deg), rel=0.05)
    (wider,) = scaled(found, np.array([scale]))
    sigma = scale * math.radians(sigma_deg)
    off = np.linspace(-2.0, 2.0, 9) * sigma
    expected = np.exp(-0.5 * (off / sigma) ** 2) / (math.sqrt(2.0 * math.pi) * sigma)
    assert at(wider, angle + off) == pytest.approx(expected, rel=0.15, abs=0.02 / sigma)


def test_one_that_is_sharper_than_any_bearing_is_made_as_wide_as_the_best() -> None:
    assert width(density(normal(1.0, 0.2), NO_LESS)) == pytest.approx(math.radians(1.0), rel=0.1)


def test_one_that_is_a_little_sharper_is_hardly_widened() -> None:
    for sigma_deg in (0.9, 0.97):
        assert width(density(normal(1.0, sigma_deg), NO_LESS)) == pytest.approx(math.radians(1.0), rel=0.1)


def test_two_peaks_keep_their_weights_and_a_flat_one_says_nothing_at_any_scale() -> None:
    both = np.logaddexp(normal(0.5, 6.0), np.array(normal(2.5, 6.0)) + math.log(0.25))
    found = density(tuple(both.tolist()), NO_LESS)
    assert float(at(found, np.array(0.5)) / at(found, np.array(2.5))) == pytest.approx(4.0, rel=0.05)
    flat = scaled(density((0.0,) * 360, NO_LESS), np.array([0.5, 1.0, 2.0]))
    assert flat == pytest.approx(np.full((3, 360), 1.0 / (2.0 * math.pi)))


@pytest.mark.parametrize("apart_deg", [60.0, 120.0, 180.0])
def test_an_echo_keeps_its_share_where_errors_are_smaller_than_stated(apart_deg: float) -> None:
    both = np.logaddexp(normal(0.5, 6.0), np.array(normal(0.5 + math.radians(apart_deg), 6.0)) + math.log(0.25))
    found, (drawn,) = (
        density(tuple(both.tolist()), NO_LESS),
        scaled(density(tuple(both.tolist()), NO_LESS), np.array([0.5])),
    )
    beside = np.abs(np.angle(np.exp(1j * (ANGLE - 0.5)))) > math.radians(apart_deg / 2.0)
    assert float(drawn[beside].sum() / drawn.sum()) == pytest.approx(float(found[beside].sum() / found.sum()), rel=0.02)
    assert width(drawn) == pytest.approx(0.5 * width(found), rel=0.05)


def test_what_is_drawn_in_is_the_broad_lobe_and_not_an_echo_s_narrow_peak_on_its_flank() -> None:
    both = np.logaddexp(normal(0.0, 8.0), np.array(normal(0.4, 1.0)) + math.log(0.3))
    (drawn,) = scaled(density(tuple(both.tolist()), NO_LESS), np.array([0.5]))
    assert abs(np.angle(np.exp(1j * ANGLE[int(np.argmax(drawn))]))) < math.radians(5.0)


@pytest.mark.parametrize("scale", [0.2, 0.5])
def test_a_lobe_that_is_drawn_in_between_two_directions_keeps_its_share(scale: float) -> None:
    """It was looked up at the directions only: of this one a sixth was left at a scale of 0.2."""
    both = np.logaddexp(normal(math.radians(0.5), 1.0), np.array(normal(2.0, 6.0)) + math.log(0.05))
    found = density(tuple(both.tolist()), NO_LESS)
    (drawn,) = scaled(found, np.array([scale]))
    beside = np.abs(np.angle(np.exp(1j * (ANGLE - 2.0)))) < math.radians(30.0)
    assert float(drawn[beside].sum() / drawn.sum()) == pytest.approx(float(found[beside].sum() / found.sum()), rel=0.01)


@pytest.mark.parametrize("count", [8, 72, 140])
def test_one_direction_alone_stays_what_it_is(count: int) -> None:
    """Its lobe had no standard deviation: all that was said of any direction was not a number."""
    found = density((0.0, *[EXCLUDED - 1.0] * (count - 1)), NO_LESS)
    (drawn,) = scaled(found, np.array([0.5]))
    assert drawn == pytest.approx(found)


@pytest.mark.parametrize("apart_deg", [60.0, 70.0, 80.0])
def test_two_lobes_that_are_as_high_are_not_drawn_to_where_neither_is(apart_deg: float) -> None:
    """Blurred as if either were the one there is, they were one, whose middle lay in the valley between them."""
    both = np.logaddexp(normal(1.0, 10.0), normal(1.0 + math.radians(apart_deg), 10.0))
    (drawn,) = scaled(density(tuple(both.tolist()), NO_LESS), np.array([0.5]))
    off = np.angle(np.exp(1j * (ANGLE[int(np.argmax(drawn))] - np.array([1.0, 1.0 + math.radians(apart_deg)]))))
    assert np.abs(off).min() < math.radians(2.0)


@given(st.lists(st.floats(EXCLUDED - 0.05, 0.0), min_size=8, max_size=360), st.floats(0.5, 2.0))
def test_the_density_is_one(values: list[float], scale: float) -> None:
    for found in scaled(density(tuple(values), NO_LESS), np.array([1.0, scale])):
        assert found.min() >= 0.0
        assert float(found.mean() * 2.0 * math.pi) == pytest.approx(1.0)
