"""A sweep that another antenna heard: recognized, found by its main lobe, and stated with a sigma that holds."""

from __future__ import annotations

import dataclasses
import math
import os
from pathlib import Path

import numpy as np
import pytest

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.comparison import known_right
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import (
    SMALL_YAGI,
    borrowed_pattern,
    load_pattern,
    parse_pattern,
    read_turntable,
    save_pattern,
)
from hardware.readings import BearingReading
from hardware.reasons.sweep import LikelyOtherAntenna, PatternBorrowed
from tests.benchmarks.pattern_mismatch import Mismatch, mismatches, principal_axis_deg, sweep_of

FINDER = SparseDirectionFinder()
ROWS = {row.name: row for row in mismatches()}
RECORDED = Path(os.environ.get("CROSSFIX_RECORDINGS", "recordings")) / "antenna_pattern_measured_36.csv"


def heard(row: Mismatch, slices: int, count: int, seed: int = 3) -> tuple[list[BearingReading], np.ndarray, np.ndarray]:
    """Readings, their errors and the principal axis' errors in degrees."""
    rng = np.random.default_rng(seed)
    truths = rng.uniform(0.0, 360.0, count)
    sweeps = [sweep_of(row, slices, math.inf, float(truth), rng) for truth in truths]
    readings = [FINDER.estimate(sweep, row.pattern) for sweep in sweeps]
    assert all(reading.accepted for reading in readings)
    error = (np.array([r.bearing_deg for r in readings]) - truths + 180.0) % 360.0 - 180.0
    axis = (np.array([principal_axis_deg(s) for s in sweeps]) - truths + 180.0) % 360.0 - 180.0
    return readings, error, axis


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


@pytest.mark.parametrize(
    "name",
    ["right pattern", "beam 20 % wider", "squint 10 degrees", "flanks 0.75 and 1.25", "foreign, lumpy lobe"],
)
def test_two_sigma_hold_for_every_pattern(name: str) -> None:
    readings, error, _ = heard(ROWS[name], 16, 24)
    inside = np.abs(error) < 2.0 * np.array([r.sigma_deg for r in readings])
    assert inside.mean() >= 0.9


def test_a_foreign_antenna_is_recognized_and_no_worse_than_a_principal_axis() -> None:
    readings, error, axis = heard(ROWS["foreign, lumpy lobe"], 36, 16)
    recognized = [any(isinstance(r, LikelyOtherAntenna) for r in reading.remarks) for reading in readings]
    assert np.mean(recognized) > 0.9
    assert rms(error) <= rms(axis)


@pytest.mark.skipif(not RECORDED.exists(), reason="the recordings are not on this machine")
def test_a_measured_antenna_through_the_default_pattern_is_no_worse_than_a_principal_axis() -> None:
    row = Mismatch("measured", read_turntable(RECORDED), load_pattern(SMALL_YAGI))
    readings, error, axis = heard(row, 36, 60)
    assert rms(error) <= rms(axis)
    assert (np.abs(error) < 2.0 * np.array([r.sigma_deg for r in readings])).mean() >= 0.9


def test_the_right_pattern_is_not_suspected_and_stays_sharp_where_it_was_checked() -> None:
    checked = known_right(ROWS["right pattern"].pattern)
    readings, error, _ = heard(Mismatch("checked", checked, checked), 16, 24)
    assert not any(reading.remarks for reading in readings)
    assert rms(error) < 2.44  # 1.25 times the bound


def test_the_right_pattern_that_nobody_checked_is_better_than_a_principal_axis() -> None:
    """Its flanks may be uneven, so that it is less sharp."""
    readings, error, axis = heard(ROWS["right pattern"], 16, 40)
    assert not any(reading.remarks for reading in readings)
    assert rms(error) < rms(axis)


def test_uneven_flanks_cost_less_than_they_cost_a_principal_axis() -> None:
    _, error, axis = heard(ROWS["flanks 0.75 and 1.25"], 36, 40)
    assert rms(error) < rms(axis)
    assert rms(error) < 9.0  # 10.8 without


def test_a_turn_of_270_degrees_is_used_wherever_the_emitter_is() -> None:
    readings, error, _ = heard(ROWS["right pattern, turned 270 degrees"], 16, 24, seed=5)
    sigma = np.array([r.sigma_deg for r in readings])
    assert (np.abs(error) < 2.0 * sigma).mean() >= 0.9
    assert np.median(sigma) < 12.0


def test_sigma_is_as_wide_as_the_patterns_origin_is_doubtful() -> None:
    yagi = load_pattern(SMALL_YAGI)
    checked = dataclasses.replace(yagi, pointing_sigma_deg=1.0)
    rng = np.random.default_rng(2)
    sweep = sweep_of(Mismatch("own", yagi, yagi), 36, math.inf, 70.0, rng)
    narrow, plain, wide = (FINDER.estimate(sweep, p) for p in (checked, yagi, borrowed_pattern()))
    assert narrow.sigma_deg < plain.sigma_deg < wide.sigma_deg
    assert narrow.pattern_sigma_deg == 1.0
    assert plain.sigma_deg == pytest.approx(math.hypot(plain.pattern_sigma_deg, narrow.sigma_deg), abs=0.3)
    assert not plain.remarks
    assert wide.remarks == (PatternBorrowed(yagi.name),)


def test_the_files_pattern_keeps_what_was_measured_of_its_pointing(tmp_path: Path) -> None:
    pattern: AntennaPattern = dataclasses.replace(load_pattern(SMALL_YAGI), pointing_sigma_deg=2.5)
    save_pattern(pattern, tmp_path / "own.json")
    assert parse_pattern("own.json", (tmp_path / "own.json").read_text()).pointing_sigma_deg == 2.5
