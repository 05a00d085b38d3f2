"""What bearings are off by together is found, whatever it is; what is not the same for all is not taken for it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.direction_finding.heading_offset import HeadingOffset, heading_offset

AROUND = np.array([(0.0, -100.0), (110.0, 20.0), (-60.0, 90.0), (-90.0, -50.0)])
EMITTER = np.array([12.0, -7.0])
SIGMA = np.full(4, 1.5)
DOUBT = 0.1


def bearings(places: np.ndarray, emitter: np.ndarray = EMITTER) -> np.ndarray:
    away = emitter - places
    return np.degrees(np.arctan2(away[:, 0], away[:, 1])) % 360.0


def found(places: np.ndarray, bearing_deg: np.ndarray) -> HeadingOffset:
    offset = heading_offset(places, bearing_deg % 360.0, SIGMA[: len(places)], DOUBT)
    assert offset is not None
    return offset


@settings(max_examples=15, deadline=None)
@given(offset=st.floats(-40.0, 40.0), east=st.floats(-500.0, 500.0), north=st.floats(-500.0, 500.0))
def test_a_common_offset_is_found_wherever_the_flight_was(offset: float, east: float, north: float) -> None:
    shift = np.array([east, north])
    told = found(AROUND + shift, bearings(AROUND + shift, EMITTER + shift) + offset)
    assert told.offset_deg == pytest.approx(offset, abs=0.1)


@pytest.mark.parametrize("offset", [-20.0, -10.0, 10.0, 20.0])
def test_an_offset_of_the_compass_is_told(offset: float) -> None:
    assert found(AROUND, bearings(AROUND) + offset).significant


def test_the_standard_error_is_true_and_honest_bearings_raise_no_alarm() -> None:
    rng = np.random.default_rng(3)
    told = [found(AROUND, bearings(AROUND) + rng.normal(0.0, SIGMA)) for _ in range(80)]
    score = np.array([t.offset_deg / t.std_error_deg for t in told])
    assert 0.7 < math.sqrt(float(np.mean(score**2))) < 1.3
    assert not any(t.significant for t in told)


def test_one_outlier_among_four_is_no_offset_of_all() -> None:
    wrong = bearings(AROUND) + np.array([0.0, 0.0, 25.0, 0.0])
    assert not found(AROUND, wrong).significant


def test_an_offset_is_told_beside_an_outlier() -> None:
    places = np.vstack([AROUND, [(60.0, -80.0), (100.0, 100.0)]])
    wrong = bearings(places) + np.array([15.0, 15.0, 15.0, 15.0, 120.0, 15.0])
    told = heading_offset(places, wrong % 360.0, np.full(6, 1.5), DOUBT)
    assert told is not None
    assert told.offset_deg == pytest.approx(15.0, abs=1.0)
    assert told.significant


def test_two_bearings_tell_nothing() -> None:
    assert heading_offset(AROUND[:2], bearings(AROUND[:2]) + 20.0, SIGMA[:2], DOUBT) is None


def test_places_on_one_circle_with_the_emitter_cannot_tell() -> None:
    """The danger circle: every offset moves the crossing along it, and all lines still meet."""
    angle = np.radians([20.0, 80.0, 140.0])
    places = EMITTER + 80.0 * np.array([1.0, 0.0]) + 80.0 * np.column_stack([np.cos(angle), np.sin(angle)])
    told = heading_offset(places, bearings(places) + 20.0, SIGMA[:3], DOUBT)
    assert told is None or not told.significant


@settings(max_examples=30, deadline=None)
@given(
    st.lists(st.tuples(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4), st.floats(0.0, 360.0)), max_size=6),
    st.floats(0.0, 180.0),
)
def test_any_bearings_give_numbers_or_none(rows: list[tuple[float, float, float]], sigma_deg: float) -> None:
    places = np.array([(e, n) for e, n, _ in rows]).reshape(-1, 2)
    told = heading_offset(places, np.array([z for *_, z in rows]), np.full(len(rows), sigma_deg), DOUBT)
    assert told is None or np.isfinite([told.offset_deg, told.std_error_deg, told.gain]).all()
