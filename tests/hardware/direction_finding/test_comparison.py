"""Figures of the comparison: differences are of the same sweeps, and their standard error is true."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hardware.direction_finding.comparison import paired_deg
from hardware.readings import BearingReading
from hardware.reasons.sweep import NoDirection

NOTHING = np.full(180, np.nan)


def off(errors_deg: np.ndarray, accepted: bool = True) -> list[BearingReading]:
    """Readings of emitters due north."""
    return [
        BearingReading(e % 360.0, 1.0, 1.0, accepted, None if accepted else NoDirection(), (), NOTHING, NOTHING)
        for e in errors_deg
    ]


def north(readings: list[BearingReading]) -> list[float]:
    return [0.0] * len(readings)


def test_a_finder_is_no_worse_than_itself() -> None:
    ours = off(np.array([1.0, -2.0, 359.0]))
    assert paired_deg(ours, ours, north(ours)) == (0.0, 0.0)


def test_the_difference_is_that_of_the_root_mean_squares() -> None:
    errors = np.array([1.0, -2.0, 3.0])
    more, _ = paired_deg(off(2.0 * errors), off(errors), [0.0] * 3)
    assert more == pytest.approx(math.sqrt(np.mean(errors**2)))


def test_only_sweeps_that_both_can_use_are_compared() -> None:
    ours = off(np.array([1.0, -1.0, 100.0])) + off(np.array([5.0]), accepted=False)
    plain = off(np.array([1.0, -1.0, 1.0, 1.0]))
    assert paired_deg(ours, plain, north(ours)) == (0.0, 0.0)


def test_the_standard_error_is_the_spread_over_repetitions() -> None:
    rng = np.random.default_rng(1)
    told = []
    for _ in range(200):
        common = rng.normal(0.0, 2.0, 300)
        ours, plain = (off(common + rng.normal(0.0, 0.5, 300)) for _ in range(2))
        told.append(paired_deg(ours, plain, north(ours)))
    differences, errors = np.array(told).T
    assert errors.mean() == pytest.approx(differences.std(), rel=0.2)
