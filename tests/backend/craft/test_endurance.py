"""What a way is promised to take: more against the wind, around corners, from higher up, and while less is known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from air import blowing, still_air
from hypothesis import given
from hypothesis import strategies as st

from backend.craft.endurance import LEG_S, READING_PERCENT, SPREAD, Endurance, landing_s, unknown

CHARGE = SPREAD * READING_PERCENT
"""Added for a charge that is reported in whole percents."""


def test_in_still_air_a_way_takes_its_time() -> None:
    takes = still_air(0.1).way_percent([(0.0, 70.0), (140.0, 0.0)], 7.0, hover_s=20.0)
    assert takes == pytest.approx(0.1 * (30.0 + 2 * LEG_S + 20.0) + CHARGE)


def test_against_the_wind_it_takes_more_than_with_it_and_than_without() -> None:
    against, along = (blowing(6.5).way_percent([(0.0, north)], 7.0) for north in (-300.0, 300.0))
    without = blowing(0.0).way_percent([(0.0, -300.0)], 7.0)
    assert against > 2.0 * without
    assert along < without


def test_a_wind_that_is_faster_than_the_vehicle_flies_takes_for_ever_but_not_infinitely_long() -> None:
    assert 20.0 < blowing(20.0).way_percent([(0.0, -300.0)], 7.0) < math.inf


@given(north=st.floats(-2_000, 2_000), east=st.floats(-2_000, 2_000), hover=st.floats(0, 300))
def test_a_longer_way_takes_more(north: float, east: float, hover: float) -> None:
    way, endurance = [(east, north)], unknown()
    takes = endurance.way_percent(way, 7.0, hover)
    assert endurance.way_percent([*way, (10.0, 0.0)], 7.0, hover) > takes
    assert endurance.way_percent([(1.1 * east, 1.1 * north)], 7.0, hover) >= takes - 1e-9
    assert endurance.way_percent(way, 7.0, hover, climb_m=20.0) > takes


def test_a_promise_holds_for_nine_of_ten_hypotheses() -> None:
    n = 100
    takes = np.column_stack([np.linspace(0.01, 1.0, n), np.zeros(n)])
    believed = Endurance(np.zeros(n), np.zeros(n), np.full(n, 1.0 / n), takes, np.zeros((n, 2, 2)))
    assert believed.way_percent([], 7.0, 100.0) == pytest.approx(90.0 + CHARGE)


def test_while_the_wind_is_not_known_a_strong_one_against_is_allowed_for() -> None:
    assert unknown().way_percent([(0.0, 300.0)], 7.0) > blowing(6.5).way_percent([(0.0, -300.0)], 7.0)


def test_landing_from_higher_up_takes_longer() -> None:
    assert landing_s(0.0) < landing_s(10.0) < landing_s(40.0) < landing_s(120.0)
    assert landing_s(40.0) == pytest.approx(60.0)
