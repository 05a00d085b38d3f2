"""Movement time models and their fit."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refusing

from planner.motion import fit_motion, flight_time, turn_between, validate_motion
from planner.reasons import UnusableFlights, UnusableNumber
from planner.types import FullMotion, LinearConstantMotion, LinearMotion


def test_the_three_models_by_hand():
    assert flight_time(LinearMotion(5.0), 50.0) == pytest.approx(10.0)
    assert flight_time(LinearConstantMotion(7.0, 11.2), 70.0) == pytest.approx(21.2)
    full = FullMotion(turn_rate=np.deg2rad(30), acceleration=1.0, speed=8.0, constant=3.0)
    assert flight_time(full, 16.0, np.pi / 2) == pytest.approx(3.0 + 8.0 + 3.0)
    assert flight_time(full, 144.0) == pytest.approx(8.0 + 10.0 + 8.0 + 3.0)


def test_the_full_model_has_no_jump_where_cruising_begins():
    full = FullMotion()
    assert flight_time(full, 64.0 - 1e-9) == pytest.approx(flight_time(full, 64.0 + 1e-9), abs=1e-6)


@given(st.floats(-20, 20), st.floats(-20, 20))
def test_no_turn_is_longer_than_half_a_circle(a, b):
    turn = turn_between(a, b)
    assert 0.0 <= turn <= np.pi + 1e-12
    assert np.cos(turn) == pytest.approx(np.cos(a - b), abs=1e-9)


@pytest.mark.parametrize(
    "truth", [LinearMotion(4.0), LinearConstantMotion(6.5, 9.0), FullMotion(0.6, 1.3, 7.0, 2.5)], ids=str
)
def test_a_fit_finds_the_model_that_made_the_flights(truth):
    rng = np.random.default_rng(4)
    distances, turns = rng.uniform(5, 250, 60), rng.uniform(0, np.pi, 60)
    times = flight_time(truth, distances, turns) + rng.normal(0, 0.05, 60)
    fitted, errors = fit_motion(distances, turns, times)
    assert np.max(np.abs(flight_time(fitted, distances, turns) - flight_time(truth, distances, turns))) < 0.5
    assert min(errors.values()) < 0.1


def test_the_reference_models_rank_as_flown():
    """The full model predicts flights that turn and accelerate better than a straight line does (6.4.3)."""
    rng = np.random.default_rng(5)
    distances, turns = rng.uniform(10, 150, 100), rng.uniform(0, np.pi, 100)
    times = flight_time(FullMotion(), distances, turns) + rng.normal(0, 2.0, 100)
    _, errors = fit_motion(distances, turns, times)
    assert errors["full"] < errors["linear_constant"] < errors["linear"]


@pytest.mark.parametrize(
    ("distances", "turns", "times", "flaw"),
    [
        ([1, 2, 3], [0, 0, 0], [1, 2, 3], "too_few"),
        ([1, 2, 3, 4], [0, 0, 0], [1, 2, 3, 4], "lengths_differ"),
        ([1, 2, 3, np.nan], [0] * 4, [1, 2, 3, 4], "not_finite"),
        ([1, 2, 3, 4], [0] * 4, [1, 2, 3, 0], "not_finite"),
        ([5, 5, 5, 5], [0] * 4, [1, 2, 3, 4], "equal_distances"),
    ],
)
def test_unusable_flights_are_refused(distances, turns, times, flaw):
    with refusing(UnusableFlights(flaw)):
        fit_motion(np.array(distances, float), np.array(turns, float), np.array(times, float))


@pytest.mark.parametrize("motion", [LinearMotion(0.0), LinearConstantMotion(5.0, -1.0), FullMotion(speed=np.nan)])
def test_unusable_models_are_refused(motion):
    with refusing(UnusableNumber):
        validate_motion(motion)
