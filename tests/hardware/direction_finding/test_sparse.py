"""The sparse reconstruction equals a convex solver's optimum and uses the circulant structure rightly."""

from __future__ import annotations

import cvxpy as cp
import numpy as np
import pytest

from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern, make_pattern
from hardware.direction_finding.sparse import BINS, COLUMNS, PatternBank, solve_sparse

ANGLE = np.arange(0.0, 360.0, 2.0)
BEAM = make_pattern(
    "60 degree beam, 12 dB floor", ANGLE, -np.minimum(12.0 * (((ANGLE + 180) % 360 - 180) / 60) ** 2, 12)
)
BANKS = {"beam": PatternBank.of(BEAM), "yagi": PatternBank.of(load_pattern(SMALL_YAGI))}


def noisy_sweep(bank: PatternBank, rng: np.random.Generator, sources: int, filled: np.ndarray) -> np.ndarray:
    r = np.zeros(COLUMNS)
    r[rng.integers(COLUMNS, size=sources)] = rng.uniform(0.3, 1.0, sources)
    m = bank.predict(r) * 10.0 ** (rng.normal(0.0, 1.5, BINS) / 10.0)
    m[~filled] = 0.0
    return m / np.sqrt(np.sum(m**2) * BINS / filled.sum())


@pytest.mark.parametrize("name", BANKS)
def test_fourier_products_equal_the_matrix(name: str) -> None:
    bank, rng = BANKS[name], np.random.default_rng(1)
    v, r = rng.normal(size=BINS), rng.normal(size=COLUMNS)
    assert np.allclose(bank.correlate(v), bank.matrix.T @ v)
    assert np.allclose(bank.predict(r), bank.matrix @ r)
    assert np.linalg.norm(bank.matrix, axis=0) == pytest.approx(np.ones(COLUMNS), abs=0.02)


@pytest.mark.parametrize("name", BANKS)
@pytest.mark.parametrize("sources", [1, 2, 3])
@pytest.mark.parametrize("slices", [16, 60, 180])
def test_optimum_equals_a_convex_solvers(name: str, sources: int, slices: int) -> None:
    bank, rng = BANKS[name], np.random.default_rng([sources, slices])
    filled = np.zeros(BINS, dtype=bool)
    filled[np.round(np.arange(slices) * BINS / slices).astype(int) % BINS] = True
    m = noisy_sweep(bank, rng, sources, filled)
    ours = solve_sparse(bank, m, 0.3, filled)

    r = cp.Variable(COLUMNS, nonneg=True)
    weight = np.sqrt(BINS / filled.sum())
    misfit = cp.sum_squares(weight * (bank.matrix[filled] @ r - m[filled]))
    problem = cp.Problem(cp.Minimize(misfit + 0.3 * cp.sum(r)))
    problem.solve(solver=cp.CLARABEL, tol_gap_abs=1e-11, tol_gap_rel=1e-11, tol_feas=1e-11)

    assert isinstance(problem.value, float)
    assert ours.objective == pytest.approx(problem.value, abs=1e-6)
    assert (ours.r >= 0).all()
    assert ours.gap < 1e-8


def test_nothing_but_zero_gives_zero() -> None:
    assert solve_sparse(BANKS["beam"], np.zeros(BINS), 0.3).r.max() == 0.0


def test_large_penalty_empties_the_solution() -> None:
    bank = BANKS["beam"]
    m = noisy_sweep(bank, np.random.default_rng(3), 1, np.ones(BINS, dtype=bool))
    assert solve_sparse(bank, m, 2.5).r.max() == 0.0
