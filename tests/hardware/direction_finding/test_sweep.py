"""Assembly of a sweep and its bins: every sample carries the heading of its own time."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from refusals import refusing

from hardware.direction_finding.sweep import (
    BINS,
    MAXIMUM_HEADING_STEP_DEG,
    SweepError,
    assemble_sweep,
    bin_sweep,
    turned_deg,
)
from hardware.readings import HeadingSample, Place, PowerSample
from hardware.reasons.receiver import NothingHeardInTurn
from hardware.reasons.sweep import ClocksApart, HeadingsInterrupted, HeadingsNotNumbers, NoHeadingHeard, NoPositionHeard
from planner.reason import Reason

PLACE = Place(50.0, 7.0)


def headings(times: np.ndarray, rate_deg_s: float, start_deg: float = 0.0) -> list[HeadingSample]:
    return [HeadingSample(float(t), float((start_deg + rate_deg_s * t) % 360.0), PLACE) for t in times]


def powers(times: np.ndarray, **more: Any) -> list[PowerSample]:
    return [PowerSample(float(t), 868e6, -60.0 - 0.1 * float(t), **more) for t in times]


@settings(deadline=None)
@given(
    start=st.floats(0, 359.9),
    rate=st.floats(-90, 90).filter(lambda r: abs(r) > 5),
    period=st.floats(0.05, 0.9),
)
def test_headings_are_interpolated_at_each_samples_own_time_across_north(
    start: float, rate: float, period: float
) -> None:
    assume(abs(rate) * period < MAXIMUM_HEADING_STEP_DEG)
    sweep = assemble_sweep(
        powers(np.arange(0.1, 10.0, 0.05)),
        headings(np.arange(0.0, 12.0, period), rate, start),
        frequency_hz=868e6,
        altitude_amsl_m=0.0,
    )
    wanted = (start + rate * sweep.at_s) % 360.0
    assert np.max(np.abs((sweep.heading_deg - wanted + 180.0) % 360.0 - 180.0)) < 1e-6


def test_samples_in_a_gap_of_the_headings_or_outside_them_are_left_out() -> None:
    times = np.concatenate([np.arange(0.0, 4.0, 0.1), np.arange(7.0, 10.0, 0.1)])
    sweep = assemble_sweep(
        powers(np.arange(-2.0, 12.0, 0.1)), headings(times, 30.0), frequency_hz=868e6, altitude_amsl_m=0.0
    )
    assert sweep.at_s.min() >= 0.0
    assert sweep.at_s.max() <= 10.0
    assert not ((sweep.at_s > 4.0) & (sweep.at_s < 6.9)).any()


def test_power_between_headings_too_far_apart_to_say_where_the_nose_was_is_left_out_and_counted() -> None:
    """0.8 s at 30 degrees a second: it may have turned at any rate meanwhile."""
    times = np.array([t for t in np.arange(0.0, 10.0, 0.1) if not 4.05 < t < 4.75])
    heard = powers(np.arange(0.05, 9.9, 0.1))
    sweep = assemble_sweep(heard, headings(times, 30.0), frequency_hz=868e6, altitude_amsl_m=0.0)
    assert sweep.samples_without_heading == 8
    assert sweep.at_s.size == len(heard) - 8
    slow = assemble_sweep(heard, headings(times, 10.0), frequency_hz=868e6, altitude_amsl_m=0.0)
    assert slow.samples_without_heading == 0


def test_a_turn_in_which_the_vehicle_lost_its_place_is_no_sweep() -> None:
    track = [
        replace(h, position=None if 4.0 < h.at_s < 5.0 else PLACE) for h in headings(np.arange(0.0, 10.0, 0.1), 30.0)
    ]
    with pytest.raises(SweepError) as refused:
        assemble_sweep(powers(np.arange(1.0, 9.0, 0.1)), track, frequency_hz=868e6, altitude_amsl_m=0.0)
    assert refused.value.reason == NoPositionHeard()
    after = powers(np.arange(5.5, 9.0, 0.1))
    assert assemble_sweep(after, track, frequency_hz=868e6, altitude_amsl_m=0.0).position == PLACE


def test_place_that_had_jumped_is_as_unsure_as_the_jump_was_long() -> None:
    track = [replace(h, displaced_m=30.0 if h.at_s < 1.0 else 0.0) for h in headings(np.arange(0.0, 10.0, 0.1), 30.0)]
    heard = powers(np.arange(1.0, 9.0, 0.1))
    assert assemble_sweep(heard, track, frequency_hz=868e6, altitude_amsl_m=0.0).drift_m == 30.0
    assert assemble_sweep(heard, track[20:], frequency_hz=868e6, altitude_amsl_m=0.0).drift_m < 1.0


def test_clock_offset_of_the_receiver_is_taken_out() -> None:
    late = [PowerSample(s.at_s + 5.0, s.frequency_hz, s.power_db) for s in powers(np.arange(1.0, 9.0, 0.1))]
    sweep = assemble_sweep(
        late, headings(np.arange(0.0, 10.0, 0.1), 30.0), frequency_hz=868e6, altitude_amsl_m=0.0, clock_offset_s=5.0
    )
    assert sweep.heading_deg[0] == pytest.approx(30.0)


def test_unordered_input_nan_headings_and_clipping_are_handled() -> None:
    track = headings(np.arange(0.0, 10.0, 0.1), 30.0)
    track[5] = HeadingSample(0.5, float("nan"), PLACE)
    heard = powers(np.arange(0.0, 9.0, 0.1), clipped=True)
    sweep = assemble_sweep(heard[::-1], track[::-1], frequency_hz=868e6, altitude_amsl_m=0.0)
    assert (np.diff(sweep.at_s) > 0).all()
    assert sweep.clipped_samples == sweep.at_s.size
    assert np.allclose(sweep.heading_deg, 30.0 * sweep.at_s)


def test_drift_while_turning_is_measured_from_the_mean_place() -> None:
    track = [HeadingSample(t, 30.0 * t % 360.0, Place(50.0 + 1e-5 * t, 7.0)) for t in np.arange(0.0, 12.0, 0.1)]
    sweep = assemble_sweep(powers(np.arange(0.0, 11.0, 0.1)), track, frequency_hz=868e6, altitude_amsl_m=0.0)
    assert sweep.drift_m == pytest.approx(6.6, abs=0.2)


def test_a_turn_that_drifts_across_the_antimeridian_was_taken_there() -> None:
    """It was taken at the mean of 180 and -180 degrees, half the world away, and thrown away for how far it drifted."""
    times = np.arange(0.0, 12.0, 0.1)
    lons = np.where(times < 6.0, 180.0 - 4e-6, -180.0 + 4e-6).tolist()
    track = [replace(h, position=Place(0.0, lon)) for h, lon in zip(headings(times, 30.0), lons, strict=True)]
    sweep = assemble_sweep(powers(times), track, frequency_hz=868e6, altitude_amsl_m=0.0)
    assert abs(sweep.position.lon) == pytest.approx(180.0, abs=1e-6)
    assert sweep.drift_m < 1.0


@pytest.mark.parametrize(
    ("heard", "track", "reason"),
    [
        ([], headings(np.arange(0.0, 2.0, 0.1), 30.0), NothingHeardInTurn()),
        (powers(np.arange(0.0, 2.0, 0.1)), [], NoHeadingHeard()),
        (powers(np.arange(100.0, 102.0, 0.1)), headings(np.arange(0.0, 2.0, 0.1), 30.0), ClocksApart),
        (powers(np.arange(2.0, 3.0, 0.1)), headings(np.array([0.0, 0.5, 9.0, 9.5]), 30.0), HeadingsInterrupted(1.0)),
        (powers(np.arange(0.0, 2.0, 0.1)), headings(np.full(9, np.nan), 30.0), HeadingsNotNumbers()),
    ],
)
def test_nothing_to_assemble_says_why(heard: list, track: list, reason: Reason | type[Reason]) -> None:
    with refusing(reason, SweepError):
        assemble_sweep(heard, track, frequency_hz=868e6, altitude_amsl_m=0.0, position=PLACE)


def test_empty_bins_are_nan_not_zero_and_means_are_of_decibels() -> None:
    binned = bin_sweep(np.array([0.5, 1.5, 90.0]), np.array([-60.0, -62.0, -80.0]), 0.0)
    assert binned.power_db[0] == pytest.approx(-61.0)
    assert binned.heading_deg[0] == pytest.approx(1.0)
    assert binned.count[45] == 1
    assert np.isnan(binned.power_db[binned.count == 0]).all()
    assert int(binned.filled.sum()) == 2
    assert binned.largest_gap_deg == pytest.approx(270.5)
    assert binned.gap_start_deg == pytest.approx(90.0)


@settings(deadline=None)
@given(st.lists(st.floats(0, 359.999), min_size=1, max_size=500), st.floats(-400, 400))
def test_every_sample_lands_in_one_bin_and_offset_turns_the_antenna(heading: list[float], offset: float) -> None:
    binned = bin_sweep(np.array(heading), np.zeros(len(heading)), offset)
    assert binned.count.sum() == len(heading)
    front = (np.array(heading) + offset) % 360.0 % 360.0
    expected = np.bincount(np.minimum((front / 2.0).astype(int), BINS - 1), minlength=BINS)
    assert (binned.count == expected).all()


def test_turned_counts_more_than_one_turn_either_way() -> None:
    angle = np.arange(0.0, 500.0, 10.0)
    assert turned_deg(angle % 360.0) == pytest.approx(490.0)
    assert turned_deg(-angle % 360.0) == pytest.approx(490.0)
