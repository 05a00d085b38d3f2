"""Non-negative sparse reconstruction of a sweep, exactly and fast.

    r* = argmin_{r >= 0} |A r - m|^2 + lambda sum(r)          (spec section 6; thesis 6.2.3)

A (180, 720): column j is the antenna's linear power pattern pointed at 0.5 j degrees, seen from the 180 bin centres.
Rows are shifts of one pattern sampled every 0.5 degrees, so A v and A' v are circular convolutions (FFT of length 720).
The optimum is found by an active set (Lawson & Hanson 1974, ch. 23, with the linear term), which ends at a point that
satisfies the Karush-Kuhn-Tucker conditions: no step size, no stopping heuristics.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.sweep import BINS

COLUMNS = 720
COLUMN_DEG = 360.0 / COLUMNS
_PER_BIN = COLUMNS // BINS
_FIRST = _PER_BIN // 2
"""Bin i is centred on column 4 i + 2."""
_ROWS = _FIRST + _PER_BIN * np.arange(BINS)
_KKT_TOLERANCE = 1e-10


@dataclass(frozen=True, slots=True)
class PatternBank:
    """The 720 shifts of one antenna pattern.

    shape: (720,) linear power against (source bearing - antenna heading) at 0.5 k degrees, scaled so that a column
    of A over all 180 bins has unit norm (on average over the four sub-bin shifts).
    scale: shape / (10^(gain_db / 10)). matrix: (180, 720) A. spectrum: (361,) rfft of shape.
    """

    shape: NDArray[np.float64]
    scale: float
    matrix: NDArray[np.float64]
    spectrum: NDArray[np.complex128]

    @classmethod
    def of(cls, pattern: AntennaPattern) -> PatternBank:
        """Columns of the pattern's gain interpolated at every half degree."""
        gain_db = pattern.gain_at(np.linspace(0.0, 360.0, COLUMNS, endpoint=False))
        power = 10.0 ** (gain_db / 10.0)
        scale = 1.0 / np.sqrt(np.sum(power**2) / _PER_BIN)
        shape = power * scale
        matrix = shape[(np.arange(COLUMNS)[None, :] - _ROWS[:, None]) % COLUMNS]
        return cls(shape, float(scale), matrix, np.fft.rfft(shape))

    def correlate(self, v: NDArray[np.float64]) -> NDArray[np.float64]:
        """A' v: (180,) -> (720,)."""
        spread = np.zeros(COLUMNS)
        spread[_ROWS] = v
        return np.fft.irfft(np.fft.rfft(spread) * self.spectrum, COLUMNS)

    def predict(self, r: NDArray[np.float64]) -> NDArray[np.float64]:
        """A r: (720,) -> (180,)."""
        return np.fft.irfft(np.fft.rfft(r) * np.conj(self.spectrum), COLUMNS)[_ROWS]


@dataclass(frozen=True, slots=True)
class SparseSolution:
    """r: (720,) the optimum. objective: its value. iterations: columns tried. gap: the largest KKT violation."""

    r: NDArray[np.float64]
    objective: float
    iterations: int
    gap: float


def solve_sparse(
    bank: PatternBank, m: NDArray[np.float64], penalty: float, filled: NDArray[np.bool_] | None = None
) -> SparseSolution:
    """The optimum of |W (A r - m)|^2 + penalty sum(r), r >= 0.

    m: (180,) linear power. filled: (180,) rows that count; the others are left out, and the kept rows are weighted by
    W = sqrt(180 / filled) so that a column's norm, and with it the meaning of `penalty`, stays that of a full turn.
    """
    rows = np.ones(BINS, dtype=bool) if filled is None else filled
    weight = np.where(rows, BINS / max(int(rows.sum()), 1), 0.0)
    target = np.where(rows, m, 0.0)
    # gradient of the objective / 2:  A' W^2 (A r - m) + penalty / 2
    linear = bank.correlate(weight * target) - penalty / 2.0
    root = np.sqrt(weight)
    r = np.zeros(COLUMNS)
    active: list[int] = []
    barred: set[int] = set()
    slope = linear.copy()
    iterations = 0
    while iterations < 3 * COLUMNS:
        allowed = slope.copy()
        allowed[active] = -np.inf
        if barred:
            allowed[list(barred)] = -np.inf
        enter = int(np.argmax(allowed))
        if allowed[enter] <= _KKT_TOLERANCE:
            break
        iterations += 1
        previous = r[active].copy()
        active.append(enter)
        values, active_now = _inner(bank, root, linear, active, np.append(previous, 0.0))
        if enter not in active_now:
            barred.add(enter)  # rounding: the column cannot grow although its slope says so
        else:
            barred.clear()
        active = active_now
        r = np.zeros(COLUMNS)
        r[active] = values
        slope = linear - bank.correlate(weight * bank.predict(r))
    residual = root * (bank.predict(r) - target)
    objective = float(residual @ residual + penalty * r.sum())
    idle = r <= 0
    gap = max(float(np.max(slope[idle], initial=0.0)), float(np.max(np.abs(slope[~idle]), initial=0.0)))
    return SparseSolution(r, objective, iterations, gap)


def _inner(
    bank: PatternBank,
    root: NDArray[np.float64],
    linear: NDArray[np.float64],
    active: list[int],
    start: NDArray[np.float64],
) -> tuple[NDArray[np.float64], list[int]]:
    """Least squares on the active columns, dropping columns until all values are positive."""
    values = start
    while active:
        columns = root[:, None] * bank.matrix[:, active]
        free = _solve(columns.T @ columns, linear[active])
        if (free > 0).all():
            return free, active
        shrinking = free <= 0
        # the furthest step from `values` towards `free` that keeps every value non-negative
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.min(np.where(shrinking, values / (values - free), np.inf))
        values = values + min(max(step, 0.0), 1.0) * (free - values)
        keep = values > 1e-14
        keep[shrinking & (values <= values[shrinking].min())] = False
        active = [column for column, kept in zip(active, keep, strict=True) if kept]
        values = values[keep]
    return np.empty(0), []


def _solve(gram: NDArray[np.float64], right: NDArray[np.float64]) -> NDArray[np.float64]:
    """Columns half a degree apart are nearly parallel; least squares takes over where Cholesky gives up."""
    from scipy.linalg import LinAlgError, cho_factor, cho_solve  # as in refine.py: only sweeps need it

    try:
        return cho_solve(cho_factor(gram), right)
    except LinAlgError:
        return np.asarray(np.linalg.lstsq(gram, right, rcond=None)[0], dtype=np.float64)
