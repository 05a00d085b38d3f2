"""A wave that fades slowly during a turn, and a receiver whose scale is compressed: in the bearing and in its sigma."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from hardware.direction_finding import explained
from hardware.direction_finding.bent_lobes import BentLobes, log_evidence
from hardware.direction_finding.comparison import beam, known_right
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.slices import slices_of
from hardware.direction_finding.slow_fading import SLOPES, SPREADS_DB, fading_field
from hardware.direction_finding.sweep import bin_sweep
from hardware.readings import Place, Sweep

BEAM = known_right(beam(60.0))
HEADINGS: NDArray[np.float64] = np.arange(0.0, 360.0, 6.0)
TIMES = HEADINGS / 30.0
SWEEPS = 40
Heard = Callable[[NDArray[np.float64], np.random.Generator], NDArray[np.float64]]


def fading(gain_db: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    """Of 3 dB, alike over some 25 degrees."""
    off = (HEADINGS[:, None] - HEADINGS + 180.0) % 360.0 - 180.0
    return gain_db + rng.multivariate_normal(np.zeros(HEADINGS.size), 9.0 * np.exp(-0.5 * (off / 25.0) ** 2))


def compressed(gain_db: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    """Half a decibel for one, and half a decibel of noise."""
    return 0.5 * gain_db + rng.normal(0.0, 0.5, HEADINGS.size)


def measured(heard: Heard) -> tuple[float, float]:
    """RMS error in degrees, and the share of bearings within two sigma."""
    finder, rng = SparseDirectionFinder(minimum_quality=0.0), np.random.default_rng(7)
    off, held = [], []
    for k in range(SWEEPS):
        truth = 9.0 * k
        sweep = Sweep(TIMES, HEADINGS, heard(BEAM.gain_at(truth - HEADINGS), rng) - 50.0, 868e6, Place(0.0, 0.0), 0.0)
        found = finder.estimate(sweep, BEAM)
        off.append((found.bearing_deg - truth + 180.0) % 360.0 - 180.0)
        held.append(abs(off[-1]) <= 2.0 * found.sigma_deg)
    return float(np.sqrt(np.mean(np.square(off)))), float(np.mean(held))


@pytest.mark.parametrize("heard", [fading, compressed])
def test_bearings_are_better_for_it_and_within_their_sigma(heard: Heard, monkeypatch: pytest.MonkeyPatch) -> None:
    rms, held = measured(heard)
    monkeypatch.setattr(explained, "FADING_ODDS", 1e-9)
    rms_without, held_without = measured(heard)
    assert held >= 0.9
    assert (rms, -held) < (0.95 * rms_without, -held_without)


def test_it_bends_the_lobe_and_the_back_alike() -> None:
    field = fading_field(BEAM)
    assert np.ptp(field.spread_db) == 0.0
    assert field.mean_db[-1] == pytest.approx(SLOPES[-1] * field.mean_db[0])
    assert field.times == SPREADS_DB


@pytest.mark.parametrize("noise_db", [None, -58.0])
def test_lobes_bent_several_times_as_much_are_as_so_many_lobes(noise_db: float | None) -> None:
    field, at = fading_field(BEAM), np.arange(0.0, 360.0, 20.0)
    binned = bin_sweep(HEADINGS, fading(BEAM.gain_at(80.0 - HEADINGS), np.random.default_rng(3)) - 50.0, 0.0)
    slices = slices_of(binned, binned.power_db)
    each = [BentLobes(field.mean_db, times * field.spread_db, field.waves) for times in field.times]
    alone = np.stack([log_evidence(lobes, slices, at, -50.0, noise_db) for lobes in each], axis=1)
    assert log_evidence(field, slices, at, -50.0, noise_db) == pytest.approx(alone.reshape(-1, at.size), abs=1e-9)
