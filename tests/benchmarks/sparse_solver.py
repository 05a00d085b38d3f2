"""How long the sparse reconstruction takes and how far it is from a convex solver's optimum (figure 3).

python -m tests.benchmarks.sparse_solver --sweeps 20
"""

from __future__ import annotations

import argparse
import json
import statistics
import time

import cvxpy as cp
import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.comparison import beam
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.direction_finding.sparse import BINS, COLUMNS, PatternBank, solve_sparse
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

PENALTY = 0.3
JITTER_DB = 1.5
SLICES = (16, 60, 180)


def noisy_sweep(
    bank: PatternBank, rng: np.random.Generator, slices: int
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """(power of unit norm in all bins (180,), which bins heard something): one to three sources, even noise."""
    filled = np.zeros(BINS, dtype=bool)
    filled[np.round(np.arange(slices) * BINS / slices).astype(int) % BINS] = True
    sources = int(rng.integers(1, 4))
    r = np.zeros(COLUMNS)
    r[rng.integers(COLUMNS, size=sources)] = rng.uniform(0.3, 1.0, sources)
    m = bank.predict(r) * 10.0 ** (rng.normal(0.0, JITTER_DB, BINS) / 10.0)
    m[~filled] = 0.0
    return m / np.sqrt(np.sum(m**2) * BINS / filled.sum()), filled


def convex_optimum(bank: PatternBank, m: NDArray[np.float64], filled: NDArray[np.bool_]) -> float:
    """Of the same problem, by Clarabel."""
    r = cp.Variable(COLUMNS, nonneg=True)
    misfit = cp.sum_squares(np.sqrt(BINS / filled.sum()) * (bank.matrix[filled] @ r - m[filled]))
    problem = cp.Problem(cp.Minimize(misfit + PENALTY * cp.sum(r)))
    problem.solve(solver=cp.CLARABEL, tol_gap_abs=1e-11, tol_gap_rel=1e-11, tol_feas=1e-11)
    return float(problem.value)  # type: ignore[arg-type]


def measured(sweeps: int, seed: int) -> dict[str, float]:
    """Milliseconds of one solution, and the largest relative difference of the objectives."""
    rng, taken_ms, apart = np.random.default_rng(seed), list[float](), list[float]()
    for pattern in (beam(60.0), load_pattern(SMALL_YAGI)):
        bank = PatternBank.of(pattern)
        for number in range(sweeps):
            m, filled = noisy_sweep(bank, rng, SLICES[number % len(SLICES)])
            solve_sparse(bank, m, PENALTY, filled)
            began = time.perf_counter()
            ours = solve_sparse(bank, m, PENALTY, filled).objective
            taken_ms.append(1e3 * (time.perf_counter() - began))
            optimum = convex_optimum(bank, m, filled)
            apart.append(abs(ours - optimum) / optimum)
    return {"median_ms": statistics.median(taken_ms), "worst_ms": max(taken_ms), "relative_difference": max(apart)}


def figures(found: dict[str, float], sweeps: int) -> list[Figure]:
    return [
        wanted("sparse", round(found["worst_ms"], 2), note=f"worst of {sweeps} sweeps"),
        wanted("sparse_optimum", float(f"{found['relative_difference']:.2g}"), note="at most"),
        plain("sparse reconstruction, median", round(found["median_ms"], 2), "ms"),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sweeps", type=int, default=20, help="for each of two antenna patterns")
    parser.add_argument("--seed", type=int, default=1)
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    found = measured(given.sweeps, given.seed)
    print(json.dumps(found, indent=2))
    title, page = "Sparse reconstruction", "direction-finding.md#the-direction-finder"
    write(given.out, "sparse_solver", title, begun, figures(found, 2 * given.sweeps), page=page)


if __name__ == "__main__":
    main()
