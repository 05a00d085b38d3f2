"""A wave that fades slowly during a turn, and a receiver whose scale is compressed: in the bearing and in its sigma."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from hardware.direction_finding import explained
from hardware.direction_finding.bent import BEARINGS_DEG
from hardware.direction_finding.comparison import beam, known_right
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.refine import PatternCurve
from hardware.direction_finding.slices import LOG_NOISE_PRIOR, NOISE_DB, Slices
from hardware.direction_finding.slow_fading import ALIKE_DEG, SLOPES, SPREADS_DB, log_evidence
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


@pytest.mark.parametrize("noise_db", [None, -58.0])
def test_its_evidence_is_that_of_the_equation(noise_db: float | None) -> None:
    heard = fading(BEAM.gain_at(80.0 - HEADINGS), np.random.default_rng(3)) - 50.0
    found = log_evidence(PatternCurve(BEAM), Slices(HEADINGS, heard, smooth=False), -50.0, noise_db)
    apart = (HEADINGS[:, None] - HEADINGS + 180.0) % 360.0 - 180.0
    alike = np.exp(-0.5 * (apart / ALIKE_DEG) ** 2)
    for row, (slope, spread_db) in enumerate(product(SLOPES, SPREADS_DB)):
        for column in (0, 17, 50):
            gain_db = PatternCurve(BEAM).gain_db(BEARINGS_DEG[column] - HEADINGS) - PatternCurve(BEAM).peak_db
            wave = 10.0 ** ((slope * gain_db - 50.0) / 10.0)
            total = wave + (0.0 if noise_db is None else 10.0 ** (noise_db / 10.0))
            rest, level = heard - 10.0 * np.log10(total), wave / total
            each = []
            for noise, prior in zip(NOISE_DB, LOG_NOISE_PRIOR, strict=True):
                c = spread_db**2 * alike + noise**2 * np.eye(HEADINGS.size)
                inverse, held = np.linalg.inv(c), level @ np.linalg.solve(c, level)
                squares = rest @ inverse @ rest - (level @ inverse @ rest) ** 2 / held
                each.append(prior - 0.5 * (squares + np.linalg.slogdet(c)[1] + np.log(held / HEADINGS.size)))
            assert found[row, column] == pytest.approx(np.logaddexp.reduce(each), abs=1e-6)
