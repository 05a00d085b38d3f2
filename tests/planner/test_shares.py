"""Intervals of shares are those of the books."""

from __future__ import annotations

import pytest

from planner.shares import wilson


def test_wilsons_interval() -> None:
    """Newcombe 1998, table I: 81 of 263; statsmodels' proportion_confint: 8 of 10."""
    assert wilson(81, 263) == pytest.approx((0.2553, 0.3662), abs=5e-4)
    assert wilson(8, 10) == pytest.approx((0.4902, 0.9433), abs=1e-4)
    assert str(wilson(0, 60)[0]) == "0.0"  # not "-0.0"
    assert wilson(60, 60)[1] == pytest.approx(1.0)
    assert wilson(0, 0) == (0.0, 1.0)
