"""Silence speaks against places that would have been heard, never too loudly, and only of what was listened to."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.detection import LATTICE, DetectionModel, Silence, silence_log_likelihood

MODEL = DetectionModel(margin_db=20.0)
AHEAD = -np.minimum(12.0 * (((np.arange(360) + 180) % 360 - 180) / 60.0) ** 2, 15.0)
EVERYWHERE = np.full(16, 3.0)


def silence(chances: np.ndarray, x: float = 0.0, y: float = 0.0) -> Silence:
    return Silence(x, y, tuple(chances.tolist()), tuple(AHEAD.tolist()))


def at(model: DetectionModel, chances: np.ndarray, distance: float, direction_deg: float) -> float:
    x = np.array([distance * math.cos(math.radians(direction_deg))])
    y = np.array([distance * math.sin(math.radians(direction_deg))])
    return float(silence_log_likelihood(model, [silence(chances)], x, y)[0])


def test_silence_speaks_against_near_places_and_not_against_far_ones() -> None:
    said = [at(MODEL, EVERYWHERE, distance, 30.0) for distance in (20.0, 100.0, 300.0, 1000.0, 20_000.0)]
    assert said == sorted(said)
    assert said[0] == pytest.approx(math.log(MODEL.never), abs=0.05)
    assert said[-1] > -0.02


def test_only_what_was_listened_to_counts() -> None:
    half = np.where(np.arange(16) < 8, 3.0, 0.0)  # the antenna pointed north of east and west only
    assert at(MODEL, half, 150.0, 90.0) < at(MODEL, half, 150.0, 270.0) - 0.2
    assert at(MODEL, np.zeros(16), 20.0, 90.0) == 0.0


def test_a_hundred_pulses_are_not_a_hundred_witnesses() -> None:
    once, often = at(MODEL, EVERYWHERE, 400.0, 0.0), at(MODEL, 30.0 * EVERYWHERE, 400.0, 0.0)
    assert often < once
    assert often > 6.0 * once  # thirty times as many chances, but one emitter of one unknown power


def test_ten_turns_at_one_place_are_not_ten_witnesses_and_never_exclude() -> None:
    x, y = np.array([300.0]), np.array([0.0])
    one, ten = (float(silence_log_likelihood(MODEL, [silence(EVERYWHERE)] * count, x, y)[0]) for count in (1, 10))
    assert max(math.log(MODEL.never), 2.0 * one) < ten < one


def test_many_places_get_what_each_would_get_alone() -> None:
    side = np.linspace(-400.0, 400.0, 2 * LATTICE)
    x, y = np.meshgrid(side, side)
    turns = [silence(EVERYWHERE), silence(EVERYWHERE, 200.0, -150.0)]
    found = silence_log_likelihood(MODEL, turns, x, y)
    some = np.s_[::37, ::29]
    assert found[some] == pytest.approx(silence_log_likelihood(MODEL, turns, x[some], y[some]), abs=0.05)


def test_a_known_strong_emitter_is_excluded_further_out_than_an_unknown_one() -> None:
    sure = DetectionModel(margin_db=20.0, spread_db=2.0)
    assert at(sure, EVERYWHERE, 250.0, 0.0) < at(MODEL, EVERYWHERE, 250.0, 0.0)


def test_agrees_with_simulated_silence() -> None:
    rng, model = np.random.default_rng(4), DetectionModel(margin_db=10.0, never=0.1)
    heading = 2.0 * math.pi * np.arange(16) / 16
    relative = np.rint(np.degrees(0.7 - heading)).astype(int) % 360
    margin = model.margin_db + AHEAD[relative] - 10.0 * model.exponent * math.log10(260.0 / model.reference_m)
    silent = 0
    for _ in range(20_000):
        if rng.uniform() < model.never:
            silent += 1
            continue
        power = margin + rng.normal(0.0, model.spread_db)
        silent += not bool((np.repeat(power, 3) + rng.normal(0.0, model.fading_db, 48) > 0.0).any())
    assert at(model, EVERYWHERE, 260.0, math.degrees(0.7)) == pytest.approx(math.log(silent / 20_000), abs=0.05)


@given(
    st.floats(-40.0, 60.0),
    st.floats(0.5, 30.0),
    st.floats(0.05, 0.9),
    st.floats(0.0, 5000.0),
    st.lists(st.floats(0.0, 200.0), min_size=4, max_size=40),
)
def test_no_place_is_ever_excluded_nor_made_likelier(
    margin: float, spread: float, never: float, distance: float, chances: list[float]
) -> None:
    model = DetectionModel(margin_db=margin, spread_db=spread, never=never)
    said = at(model, np.array(chances), distance, 45.0)
    assert math.log(never) - 1e-9 <= said <= 1e-9
