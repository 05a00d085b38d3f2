"""Directions that a turn fits nearly as well as its bearing: named, and said."""

from __future__ import annotations

import numpy as np
import pytest

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.circle import SweepLikelihood
from hardware.direction_finding.comparison import beam, known_right
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.likely_too import likely_too, new_beside
from hardware.direction_finding.pattern_file import make_pattern
from hardware.readings import BearingPeak, BearingReading, Place, Sweep
from hardware.reasons.sweep import OtherDirectionLikely

ANGLES = np.arange(0.0, 360.0, 5.0)
DIPOLE = known_right(make_pattern("dipole", ANGLES, 10.0 * np.log10(np.cos(np.radians(ANGLES)) ** 2 + 0.02)))
HEADINGS = np.arange(0.0, 360.0, 7.0)
TIMES = HEADINGS / 30.0


def heard_from(truth_deg: float, pattern: AntennaPattern, seed: int) -> BearingReading:
    rng = np.random.default_rng(seed)
    power = pattern.gain_at(truth_deg - HEADINGS) + rng.normal(0.0, 1.0, HEADINGS.size) - 50.0
    return SparseDirectionFinder().estimate(Sweep(TIMES, HEADINGS, power, 868e6, Place(0.0, 0.0), 0.0), pattern)


def off_deg(some: float, other: float) -> float:
    return abs((some - other + 180.0) % 360.0 - 180.0)


@pytest.mark.parametrize("seed", range(12))
def test_of_a_dipole_both_directions_are_told(seed: int) -> None:
    truth = 31.0 * seed
    found = heard_from(truth, DIPOLE, seed)
    told = [found.bearing_deg, *(peak.bearing_deg for peak in found.peaks if peak.weight > 0.25)]
    assert min(off_deg(one, truth) for one in told) < 10.0
    assert min(off_deg(one, truth + 180.0) for one in told) < 10.0
    (said,) = (remark for remark in found.remarks if isinstance(remark, OtherDirectionLikely))
    assert off_deg(said.other_bearing_deg, found.bearing_deg) == pytest.approx(180.0, abs=10.0)


def test_of_a_beam_there_is_no_other() -> None:
    found = [heard_from(31.0 * seed, known_right(beam(60.0)), seed) for seed in range(12)]
    assert not any(isinstance(remark, OtherDirectionLikely) for one in found for remark in one.remarks)


def test_the_likeliest_comes_first_and_near_ones_are_one() -> None:
    density = [SweepLikelihood.normal(at, 5.0).log_likelihood + np.log(w) for at, w in ((0.0, 1.0), (200.0, 0.4))]
    density.append(SweepLikelihood.normal(100.0, 5.0).log_likelihood + np.log(0.6))
    density.append(SweepLikelihood.normal(280.0, 5.0).log_likelihood + np.log(0.1))
    found = likely_too(SweepLikelihood.of(np.logaddexp.reduce(density)), 0.0)
    assert [round(peak.bearing_deg) for peak in found] == [100, 200]
    assert [peak.weight for peak in found] == pytest.approx([0.6, 0.4], rel=0.02)
    assert not new_beside(BearingPeak(352.0, 1.0), [BearingPeak(4.0, 0.2)])
    assert new_beside(BearingPeak(352.0, 1.0), [BearingPeak(14.0, 0.2)])
