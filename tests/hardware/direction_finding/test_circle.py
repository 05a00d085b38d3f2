"""A sweep's likelihood over direction: what it keeps that a bearing and a sigma do not, and how it travels."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.direction_finding.circle import FLOOR, LikelihoodError, SweepLikelihood
from hardware.direction_finding.comparison import beam, known_right
from hardware.direction_finding.estimate import SparseDirectionFinder
from tests.benchmarks.pattern_mismatch import Mismatch, sweep_of

FINDER = SparseDirectionFinder()
NOMINAL = known_right(beam(60.0))


def likelihood_of(echoes_db: tuple[float, ...], truth: float, seed: int) -> SweepLikelihood:
    rng = np.random.default_rng(seed)
    reading = FINDER.estimate(sweep_of(Mismatch("", NOMINAL, NOMINAL, echoes_db), 36, math.inf, truth, rng), NOMINAL)
    assert reading.likelihood is not None
    return SweepLikelihood.unpacked(reading.likelihood)


def test_a_clean_sweep_is_one_narrow_peak_at_the_bearing() -> None:
    found = likelihood_of((), 200.0, 1)
    assert abs(int(np.argmax(found.log_likelihood)) - 200) < 6
    assert found.spread_deg(200.0) < 8.0


def test_echoes_leave_more_than_one_direction_possible() -> None:
    narrow = np.mean([np.sum(likelihood_of((), 90.0, seed).log_likelihood > -4.0) for seed in range(5)])
    wide = np.mean([np.sum(likelihood_of((-3.0, -3.0), 90.0, seed).log_likelihood > -4.0) for seed in range(5)])
    assert wide > 1.5 * narrow


@given(st.integers(0, 2**32 - 1), st.floats(0.1, 20.0))
def test_packed_it_comes_back_within_half_a_step(seed: int, depth: float) -> None:
    one = SweepLikelihood.of(np.random.default_rng(seed).normal(0.0, depth, 360))
    back = SweepLikelihood.unpacked(one.packed())
    assert len(one.packed()) <= 520
    assert np.max(np.abs(back.log_likelihood - one.log_likelihood)) <= 0.0251
    assert back.log_likelihood.min() >= FLOOR - 1e-9


@pytest.mark.parametrize("text", ["", "!", "AAAA", SweepLikelihood.normal(1.0, 5.0).packed()[:-8]])
def test_a_damaged_one_is_refused_in_words(text: str) -> None:
    with pytest.raises(LikelihoodError, match="likelihood"):
        SweepLikelihood.unpacked(text)


def test_blurring_adds_variances() -> None:
    assert SweepLikelihood.normal(350.0, 5.0).blurred(12.0).spread_deg(350.0) == pytest.approx(13.0, abs=0.2)
