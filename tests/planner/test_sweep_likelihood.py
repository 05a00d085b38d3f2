"""A sweep's likelihood over direction updates a place grid as a bearing does, and says what a bearing cannot."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.sweep_likelihood import direction_density, log_update

ANGLE = 2.0 * math.pi * np.arange(360) / 360
X, Y = np.meshgrid(np.arange(-150.0, 151.0, 5.0), np.arange(-150.0, 151.0, 5.0))


def normal(angle: float, sigma: float) -> np.ndarray:
    off = np.angle(np.exp(1j * (ANGLE - angle)))
    return -0.5 * (off / sigma) ** 2


@settings(max_examples=40, deadline=None)
@given(
    angle=st.floats(-math.pi, math.pi),
    own_deg=st.floats(2.0, 12.0),
    common_deg=st.floats(0.0, 8.0),
    outliers=st.floats(0.01, 0.3),
)
def test_a_clean_sweep_updates_as_its_bearing_and_sigma_do(
    angle: float, own_deg: float, common_deg: float, outliers: float
) -> None:
    own, common = math.radians(own_deg), math.radians(common_deg)
    found = log_update(normal(angle, own), (-200.0, 20.0), X, Y, outlier_probability=outliers, common_sigma=common)
    sigma = math.hypot(own, common)
    off = np.angle(np.exp(1j * (np.arctan2(Y - 20.0, X + 200.0) - angle)))
    density = np.exp(-0.5 * (off / sigma) ** 2) / (math.sqrt(2.0 * math.pi) * sigma)
    expected = np.log((1.0 - outliers) * density + outliers / (2.0 * math.pi))
    assert np.max(np.abs(found - expected)) < 0.04


def test_two_peaks_leave_two_hypotheses_and_their_weights() -> None:
    both = np.logaddexp(normal(0.5, 0.1), normal(2.5, 0.1) + math.log(0.25))
    at = log_update(
        both,
        (0.0, 0.0),
        100.0 * np.cos(np.array([0.5, 2.5, 1.5])),
        100.0 * np.sin(np.array([0.5, 2.5, 1.5])),
        outlier_probability=0.02,
    )
    assert at[0] - at[1] == pytest.approx(math.log(4.0), abs=0.05)
    assert at[1] - at[2] > 3.0


def test_a_flat_sweep_and_the_place_of_the_sensor_learn_nothing() -> None:
    flat = log_update(np.zeros(360), (3.0, 4.0), X, Y, outlier_probability=0.0)
    assert np.ptp(flat) < 1e-12
    here = log_update(normal(1.0, 0.1), (0.0, 0.0), np.zeros(1), np.zeros(1), outlier_probability=0.05)
    assert here[0] == pytest.approx(-math.log(2.0 * math.pi))


def test_a_known_offset_turns_the_wedge_back() -> None:
    east = np.array([100.0]), np.array([0.0])
    turned = normal(math.radians(10.0), math.radians(3.0))
    straight = normal(0.0, math.radians(3.0))
    assert log_update(turned, (0, 0), *east, outlier_probability=0.05, offset=math.radians(10.0)) == pytest.approx(
        log_update(straight, (0, 0), *east, outlier_probability=0.05), abs=1e-9
    )


@given(st.lists(st.floats(-12.7, 0.0), min_size=360, max_size=360), st.floats(0.0, 1.0))
def test_the_density_is_one(values: list[float], common: float) -> None:
    density = direction_density(np.array(values), common)
    assert density.min() >= 0.0
    assert float(density.mean() * 2.0 * math.pi) == pytest.approx(1.0)
