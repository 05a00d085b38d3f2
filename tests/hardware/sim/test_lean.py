"""A vehicle that leans sees the world turned about its centre."""

from __future__ import annotations

import math

import pytest

from hardware.sim.world import as_leaning


def test_what_it_leans_to_stands_higher_and_what_is_behind_lower() -> None:
    assert as_leaning(100.0, 0.0, 0.0, (0.2, 0.0)) == pytest.approx((100 * math.cos(0.2), 0.0, 100 * math.sin(0.2)))
    assert as_leaning(-100.0, 0.0, 0.0, (0.2, 0.0))[2] == pytest.approx(-100 * math.sin(0.2))
    assert as_leaning(0.0, 100.0, 0.0, (0.2, 0.0)) == pytest.approx((0.0, 100.0, 0.0)), "across it nothing changes"


def test_it_is_a_rotation_and_upright_again_when_turned_back() -> None:
    lean = (0.11, -0.23)
    seen = as_leaning(30.0, -70.0, -40.0, lean)
    assert math.hypot(*seen) == pytest.approx(math.hypot(30.0, 70.0, 40.0))
    assert as_leaning(*seen, (-lean[0], -lean[1])) == pytest.approx((30.0, -70.0, -40.0))
