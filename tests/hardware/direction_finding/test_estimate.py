"""The direction finder: accuracy against the Cramer-Rao bound, robustness to odd sweeps, rejections in words."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern, make_pattern
from hardware.readings import Place, Sweep
from hardware.reasons.receiver import NothingHeardInTurn
from hardware.reasons.sweep import (
    ConstantPower,
    DirectionInGap,
    NothingAboveNoise,
    Overdriven,
    PowerNotNumbers,
    TooFewDirections,
    TurnIncomplete,
    UnlikeAntenna,
)
from planner.reason import Reason

ANGLE = np.arange(0.0, 360.0, 1.0)
BEAM = make_pattern(
    "60 degree beam, 12 dB floor",
    ANGLE,
    -np.minimum(12.0 * (((ANGLE + 180) % 360 - 180) / 60) ** 2, 12),
    pointing_sigma_deg=0.0,
)
"""Known to be that of the antenna which hears."""
YAGI = load_pattern(SMALL_YAGI)
FINDER = SparseDirectionFinder()


def sweep_of(heading_deg: np.ndarray, power_db: np.ndarray, **more: object) -> Sweep:
    times = 0.05 * np.arange(heading_deg.size, dtype=float)
    return dataclasses.replace(
        Sweep(times, heading_deg, power_db, 868e6, Place(50.0, 7.0), 100.0),
        **more,
    )


def heard(pattern: AntennaPattern, bearing_deg: float, heading_deg: np.ndarray, level_db: float = -60.0) -> np.ndarray:
    return level_db + pattern.gain_at(bearing_deg - heading_deg - pattern.offset_to_nose_deg)


def error_deg(bearing_deg: float, truth_deg: float) -> float:
    return (bearing_deg - truth_deg + 180.0) % 360.0 - 180.0


@settings(max_examples=60, deadline=None)
@given(
    bearing=st.floats(0, 359.99),
    start=st.floats(0, 359.99),
    level=st.floats(-150, 20),
    offset=st.floats(-180, 180),
    count=st.integers(60, 500),
    turns=st.floats(1.0, 2.5),
)
def test_clean_sweep_gives_the_exact_bearing_at_any_level_offset_and_start(
    bearing: float, start: float, level: float, offset: float, count: int, turns: float
) -> None:
    pattern = dataclasses.replace(YAGI, offset_to_nose_deg=offset)
    heading = (start + turns * 360.0 * np.arange(count) / count) % 360.0
    reading = FINDER.estimate(sweep_of(heading, heard(pattern, bearing, heading, level)), pattern)
    assert reading.accepted, reading.reason
    assert abs(error_deg(reading.bearing_deg, bearing)) < 0.3
    assert 0.0 <= reading.bearing_deg < 360.0
    assert reading.quality > 0.99


def test_error_is_near_the_cramer_rao_bound_and_sigma_tells_it() -> None:
    rng = np.random.default_rng(11)
    heading = 22.5 * np.arange(16, dtype=float)
    slope = (BEAM.gain_at(0.5 - heading) - BEAM.gain_at(-0.5 - heading)) / 1.0
    bound = 1.0 / np.sqrt(np.sum((slope - slope.mean()) ** 2))
    errors, sigmas = [], []
    for bearing in rng.uniform(0, 360, 250):
        power = heard(BEAM, bearing, heading) + rng.normal(0.0, 1.0, 16)
        reading = FINDER.estimate(sweep_of(heading, power), BEAM)
        errors.append(error_deg(reading.bearing_deg, bearing))
        sigmas.append(reading.sigma_deg)
    rms = float(np.sqrt(np.mean(np.square(errors))))
    assert rms < 1.25 * bound
    assert 0.75 < np.sqrt(np.mean(np.square(np.array(errors) / np.array(sigmas)))) < 1.3


def test_second_source_is_kept_as_a_weaker_peak() -> None:
    heading = np.arange(0.0, 360.0, 2.0)
    power = 10.0 * np.log10(
        10.0 ** (heard(BEAM, 80.0, heading) / 10.0) + 0.4 * 10.0 ** (heard(BEAM, 220.0, heading) / 10.0)
    )
    reading = FINDER.estimate(sweep_of(heading, power), BEAM)
    assert abs(error_deg(reading.bearing_deg, 80.0)) < 3.0
    strongest = max(reading.peaks, key=lambda peak: peak.weight)
    assert abs(error_deg(strongest.bearing_deg, 220.0)) < 6.0
    assert 0.2 < strongest.weight < 0.7


@pytest.mark.parametrize(
    "heading",
    [
        np.sort(np.random.default_rng(1).uniform(0, 360, 150)),
        np.concatenate([np.arange(0, 150, 2.0), np.arange(200, 360, 2.0)]),
        np.arange(0.0, 300.0, 2.0),
        (400.0 * (np.arange(200) / 200) ** 2) % 360.0,
        np.arange(0, 360, 22.5),
    ],
    ids=["uneven", "gap", "less than a turn", "accelerating", "16 slices"],
)
def test_uneven_and_incomplete_turns(heading: np.ndarray) -> None:
    rng = np.random.default_rng(2)
    power = heard(YAGI, 100.0, heading) + rng.normal(0.0, 1.0, heading.size)
    reading = FINDER.estimate(sweep_of(heading, power), YAGI)
    assert reading.accepted, reading.reason
    assert abs(error_deg(reading.bearing_deg, 100.0)) < 5.0


def test_some_nan_and_outlying_samples_do_not_move_the_bearing() -> None:
    heading = np.arange(0.0, 360.0, 1.5)
    power = heard(YAGI, 200.0, heading) + np.random.default_rng(3).normal(0, 1, heading.size)
    power[::17] = np.nan
    power[5::40] -= 25.0
    reading = FINDER.estimate(sweep_of(heading, power), YAGI)
    assert reading.accepted, reading.reason
    assert abs(error_deg(reading.bearing_deg, 200.0)) < 2.0


FULL = np.arange(0.0, 360.0, 1.5)


@pytest.mark.parametrize(
    ("sweep", "reason"),
    [
        (sweep_of(np.empty(0), np.empty(0)), NothingHeardInTurn()),
        (sweep_of(FULL, np.full(FULL.size, np.nan)), PowerNotNumbers()),
        (sweep_of(FULL, heard(YAGI, 10.0, FULL), clipped_samples=60), Overdriven(60, 240)),
        (sweep_of(FULL, np.minimum(heard(YAGI, 10.0, FULL), -75.0)), Overdriven(154, 240)),
        (sweep_of(FULL[:4], heard(YAGI, 10.0, FULL[:4])), TooFewDirections(3, 8)),
        (sweep_of(FULL[:150], heard(YAGI, 10.0, FULL[:150])), TurnIncomplete(223.5)),
        (sweep_of(FULL, np.full(FULL.size, -70.0)), ConstantPower()),
        (sweep_of(FULL, -70.0 + 0.3 * np.sin(FULL * 7.7)), UnlikeAntenna),
        (sweep_of(FULL, -126.0 + 0.3 * np.sin(FULL * 7.7), noise_floor_db=-126.0), NothingAboveNoise(3.0)),
    ],
)
def test_unusable_sweeps_are_rejected_with_a_reason(sweep: Sweep, reason: Reason | type[Reason]) -> None:
    reading = FINDER.estimate(sweep, YAGI)
    assert not reading.accepted
    assert isinstance(reading.reason, reason) if isinstance(reason, type) else reading.reason == reason
    assert np.isfinite([reading.bearing_deg, reading.sigma_deg, reading.quality]).all()


def test_a_lobe_that_is_cut_off_half_way_is_used() -> None:
    reading = FINDER.estimate(sweep_of(FULL, np.minimum(heard(YAGI, 10.0, FULL), -72.0)), YAGI)
    assert reading.accepted
    assert abs(error_deg(reading.bearing_deg, 10.0)) < 2.0 * reading.sigma_deg < 60.0


def test_many_readings_at_one_heading_are_not_a_lobe_cut_off() -> None:
    turned = np.append(FULL, np.full(600, 10.5))
    assert FINDER.estimate(sweep_of(turned, np.round(heard(YAGI, 10.5, turned))), YAGI).accepted


def test_an_antenna_that_is_flat_but_for_a_null_is_not_overdriven() -> None:
    null = make_pattern("null", ANGLE, -12.0 * np.exp(-0.5 * ((ANGLE - 180.0) / 25.0) ** 2))
    assert FINDER.estimate(sweep_of(FULL, np.round(heard(null, 10.0, FULL))), null).accepted


def test_bearing_that_an_unheard_arc_hides_is_rejected() -> None:
    heading = np.arange(0.0, 245.0, 2.0)  # the lobe, 60 degrees to each side, lies inside the arc altogether
    power = heard(BEAM, 302.0, heading) + np.random.default_rng(1).normal(0.0, 1.0, heading.size)
    reading = FINDER.estimate(sweep_of(heading, power), BEAM)
    assert not reading.accepted
    assert reading.reason == DirectionInGap(116.0)


@pytest.mark.parametrize("seed", range(1, 6))
def test_bearing_beside_an_unheard_arc_is_read_off_the_flank_that_was_heard(seed: int) -> None:
    heading = np.arange(0.0, 280.0, 2.0)
    power = heard(BEAM, 320.0, heading) + np.random.default_rng(seed).normal(0.0, 1.0, heading.size)
    reading = FINDER.estimate(sweep_of(heading, power), BEAM)
    assert reading.accepted
    assert abs(reading.bearing_deg - 320.0) < 2.0 * reading.sigma_deg


def test_minimum_quality_is_a_setting() -> None:
    heading = np.arange(0.0, 360.0, 2.0)
    power = heard(YAGI, 10.0, heading) + np.random.default_rng(4).normal(0, 2, heading.size)
    assert SparseDirectionFinder(minimum_quality=0.5).estimate(sweep_of(heading, power), YAGI).accepted
    assert not SparseDirectionFinder(minimum_quality=0.9999).estimate(sweep_of(heading, power), YAGI).accepted


@settings(max_examples=80, deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(allow_nan=True, allow_infinity=True), st.floats(allow_nan=True, allow_infinity=True)),
        max_size=60,
    )
)
def test_any_numbers_give_a_reading_and_never_a_crash(rows: list[tuple[float, float]]) -> None:
    heading = np.array([h for h, _ in rows], dtype=float)
    power = np.array([p for _, p in rows], dtype=float)
    reading = FINDER.estimate(sweep_of(heading, power), YAGI)
    assert np.isfinite([reading.bearing_deg, reading.sigma_deg, reading.quality]).all()
    assert reading.accepted is (reading.reason is None)
