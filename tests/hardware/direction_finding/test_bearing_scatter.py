"""The sigma of bearings that state none: read off how they miss one another, the prior's where nothing contradicts."""

from __future__ import annotations

import numpy as np
import pytest

from hardware.direction_finding.bearing_scatter import TYPICAL_DEG, BearingScatter, bearing_scatter

EMITTER = np.array([60.0, 90.0])
LOW, HIGH = np.array([-600.0, -600.0]), np.array([600.0, 600.0])


def scatter(own_deg: float, count: int, wrong: int = 0, seed: int = 1) -> BearingScatter:
    rng = np.random.default_rng(seed)
    places = rng.uniform(-250.0, 250.0, (count, 2))
    off = EMITTER - places
    bearing = np.degrees(np.arctan2(off[:, 0], off[:, 1])) + rng.normal(0.0, own_deg, count)
    bearing[:wrong] += 120.0
    return bearing_scatter(places, bearing % 360.0, LOW, HIGH)


@pytest.mark.parametrize("own_deg", [4.0, 10.0, 20.0])
def test_many_bearings_show_their_sigma(own_deg: float) -> None:
    assert scatter(own_deg, 25).sigma_deg == pytest.approx(own_deg, rel=0.4)


def test_a_few_wrong_bearings_are_outliers_and_not_scatter() -> None:
    clean, wrong = scatter(5.0, 20), scatter(5.0, 20, wrong=4)
    assert wrong.outlier_probability > clean.outlier_probability + 0.05
    assert wrong.sigma_deg < 2.0 * clean.sigma_deg


def test_one_bearing_leaves_the_prior() -> None:
    assert TYPICAL_DEG < scatter(1.0, 1).sigma_deg < 2.0 * TYPICAL_DEG
