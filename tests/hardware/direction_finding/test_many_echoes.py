"""A turn among many echoes: what it still tells of the direct wave; a clear one is not taken for such a turn."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hardware.direction_finding.bent import Bent, bent
from hardware.direction_finding.comparison import beam, known_right
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.many_echoes import echo_field
from hardware.direction_finding.slices import Slices, slices_of
from hardware.direction_finding.sweep import bin_sweep
from hardware.readings import Sweep
from tests.benchmarks.pattern_mismatch import Mismatch, principal_axis_deg, sweep_of

BEAM = known_right(beam(60.0))
FIELD = echo_field(BEAM)
FOUR = Mismatch("", BEAM, BEAM, (-5.0, -6.0, -8.0, -9.0))
CLEAR = Mismatch("", BEAM, BEAM)


def off_deg(bearing_deg: float, truth_deg: float) -> float:
    return (bearing_deg - truth_deg + 180.0) % 360.0 - 180.0


def weighed(slices: Slices) -> Bent:
    return bent(FIELD, slices, 0.0, None, 0.0, 40.0)


def heard(row: Mismatch, slices: int, truth_deg: float, seed: int) -> tuple[Sweep, Slices]:
    sweep = sweep_of(row, slices, math.inf, truth_deg, np.random.default_rng(seed))
    binned = bin_sweep(sweep.heading_deg, sweep.power_db, 0.0)
    return sweep, slices_of(binned, binned.power_db)


def test_the_process_has_the_antennas_own_correlation() -> None:
    gain = 10.0 ** (BEAM.gain_at(np.arange(0.0, 360.0, 2.0)) / 20.0)
    own = np.array([np.mean(gain * np.roll(gain, lag)) for lag in range(180)])
    assert FIELD.waves @ FIELD.waves[0] == pytest.approx(own / own[0], abs=5e-3)


def test_where_the_antenna_hears_little_echoes_change_more() -> None:
    front, back = FIELD.spread_db[:, 0], FIELD.spread_db[:, 90]
    assert (back > front).all()
    assert (FIELD.mean_db[:, 90] > FIELD.mean_db[0, 0] - 12.0).all()
    assert FIELD.spread_db.max() < 5.6  # a Rayleigh wave's, in decibels


def test_a_turned_turn_gives_a_turned_bearing() -> None:
    _, slices = heard(FOUR, 36, 100.0, 1)
    turned = Slices((slices.heading_deg + 70.0) % 360.0, slices.power_db, slices.smooth)
    assert off_deg(weighed(turned).bearing_deg, weighed(slices).bearing_deg) == pytest.approx(70.0, abs=1e-6)
    assert weighed(turned).log_odds == pytest.approx(weighed(slices).log_odds)


def test_many_echoes_are_told_from_none() -> None:
    """By evidence, against the same antenna hearing one wave only."""
    clear = np.mean([weighed(heard(CLEAR, 36, 40.0 * k, k)[1]).log_odds for k in range(9)])
    echoed = np.mean([weighed(heard(FOUR, 36, 40.0 * k, k)[1]).log_odds for k in range(9)])
    assert clear > echoed + 3.0


@pytest.mark.parametrize("slices", [16, 36])
def test_its_bearings_among_echoes_are_better_than_the_principal_axis(slices: int) -> None:
    own, axis, held = [], [], []
    for k in range(40):
        truth = 9.0 * k
        sweep, parts = heard(FOUR, slices, truth, 100 + k)
        found = weighed(parts)
        own.append(abs(off_deg(found.bearing_deg, truth)))
        axis.append(abs(off_deg(principal_axis_deg(sweep), truth)))
        held.append(own[-1] < 2.0 * found.spread_deg(found.bearing_deg, 180.0))
    assert np.median(own) < 0.9 * np.median(axis)
    assert np.mean(held) > 0.85


def test_a_clear_turn_keeps_its_sharp_bearing() -> None:
    finder = SparseDirectionFinder()
    readings = [(finder.estimate(heard(CLEAR, 36, 30.0 * k, k)[0], BEAM), 30.0 * k) for k in range(12)]
    assert np.median([reading.sigma_deg for reading, _ in readings]) < 2.2
    assert np.median([abs(off_deg(reading.bearing_deg, truth)) for reading, truth in readings]) < 1.5
