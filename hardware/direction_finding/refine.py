"""Refinement between the columns: the bearing's posterior, averaged over what the sweep may show (alternatives.py).

Noise of received power is multiplicative (fading, gain jitter), so it is even in decibels; the receiver's noise N adds
in power. For alternative k with template P_k, level L and bearing b the filled bins are

    m_i = 10 log10(10^(L / 10) P_k(b - h_i) + N) + w_i,    var w_i = e^2 + (f s_i)^2

with s_i the wave's share of the power, L profiled out, e (every reading) and f (fading, which acts on the wave only)
the likeliest given the residuals; readings beyond three standard deviations are weighted down (Huber). With c_k(b) the
weighted sum of squares and the scale of w unknown, the marginal likelihood is that of Student's t (Zellner 1971,
chapter 3), tempered for residuals that err alike:

    p_k(b) ~ prior_k  c_k*^-(n / (2 r))  (c_k(b) / c_k*)^-(n / (2 q)),    c_k* = min_b c_k(b)

r: the residuals' correlation summed over neighbouring headings (Newey & West 1987); it weighs shape against shape. q:
the same, but weighted by how much each bin turns the bearing, times how much larger the residuals are there (White
1980); only correlation on the scale of the pattern's flanks makes a bearing uncertain. Near the noise the wave and its
fading are heard over an arc only: so short a record shows too little of its correlation (Kiefer & Vogelsang 2005), and
q is raised by (1 + 40 / arc) / (1 + 40 / 360), arc = 360 mean s.

The bearing is the mean of p within the likeliest kind; sigma its spread about it over all kinds. So an echo that cannot
be told from the direct wave, or a view from above, widens sigma by as much as the sweep leaves it possible.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.alternatives import KINDS, Alternatives
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.shape_fit import BearingGrid, Look, Templates
from hardware.direction_finding.sweep import BIN_DEG, BINS, BinnedSweep

HUBER = 3.0
"""Residuals beyond this many standard deviations count linearly, not quadratically."""
CORRELATION_DEG = 40.0
"""Residuals of headings further apart are independent."""
SIGMA_FLOOR_DEG = 0.25
"""Half a column."""
NEGLIGIBLE = 9.0
"""Alternatives that are worse than the best by more than this (natural log) are left out."""
FEWEST_FREE = 3.0
FIRST_CORRELATION = 4.0
"""r assumed while the residuals are not known yet."""
_SD_GRID = np.array([0.2, 0.35, 0.5, 0.7, 1.0, 1.4])
_FADING_GRID = np.array([0.0, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0])
_FADING_EVIDENCE = 2.0
"""Fading is believed when it lowers -2 log likelihood by more than this."""
_FINE_DEG = 0.25
COARSE_DEG = 2.0
LEAST_DENSITY = 1e-12
_DB = 10.0 / np.log(10.0)
_STEP_DEG = 0.5


class PatternCurve:
    """Gain at any relative bearing from a table every 0.5 degrees (circular, linear in dB)."""

    def __init__(self, pattern: AntennaPattern) -> None:
        table = pattern.gain_at(np.arange(0.0, 360.0, _STEP_DEG))
        self._table = np.append(table, table[:1])
        self.peak_db = float(table.max())
        self.beam_deg = float(np.sum(table > self.peak_db - 3.0) * _STEP_DEG)

    def gain_db(self, relative_deg: NDArray[np.float64]) -> NDArray[np.float64]:
        """relative_deg: any shape, source bearing - antenna heading, any turn of the circle."""
        table = self._table
        place = (relative_deg % 360.0) / _STEP_DEG
        low = np.minimum(place.astype(np.int64), table.size - 2)
        part = place - low
        return table[low] * (1.0 - part) + table[low + 1] * part


@dataclass(frozen=True, slots=True)
class Refined:
    """bearing_deg, sigma_deg: of the direct wave. peak_db: its power where the antenna is strongest, without noise.

    fitted_db: (180,) the likeliest alternative at the bins' centres. kinds: probability of one wave alone, of an echo
    besides, of a view from above. circle: log density of the bearing, all round.
    """

    bearing_deg: float
    sigma_deg: float
    peak_db: float
    fitted_db: NDArray[np.float64]
    kinds: tuple[float, ...]
    circle: CircleDensity


@dataclass(frozen=True, slots=True)
class CircleDensity:
    """Log density of the bearing over all shapes, unnormalized: every 5 degrees all round, and finely near the bearing.

    coarse_deg, coarse_log: (180,). fine_deg, fine_log: (j,) ascending, 0.25 degrees apart, about the bearing.
    """

    coarse_deg: NDArray[np.float64]
    coarse_log: NDArray[np.float64]
    fine_deg: NDArray[np.float64]
    fine_log: NDArray[np.float64]


def refine(
    curve: PatternCurve, alternatives: Alternatives, binned: BinnedSweep, near_deg: float, noise_db: float | None
) -> Refined:
    """The bearing near `near_deg`, which is right within half a beam. noise_db: the receiver's floor, None: unknown."""
    centre = profile_minimum(curve, binned, near_deg, noise_db)
    steps = int(min(max(2.0 * curve.beam_deg / 3.0, 16.0), 60.0) / BIN_DEG)
    around: NDArray[np.float64] = centre + BIN_DEG * np.arange(-steps, steps + 1, dtype=np.float64)
    grid = BearingGrid.of(binned, around)
    level_db = _level_db(curve, binned, centre, noise_db)
    templates = Templates(alternatives, level_db, noise_db)
    look = grid.look(templates, 0, steps, np.ones(grid.size))
    first = grid.cost(templates, _weights(look))
    free = max(grid.size / FIRST_CORRELATION, FEWEST_FREE)
    k, place = divmod(int(np.argmax(alternatives.log_prior[:, None] - 0.5 * free * np.log(first))), first.shape[1])
    look = grid.look(templates, k, place, _weights(look))
    templates = Templates(alternatives, level_db + look.shift_db, noise_db)
    weight = _weights(look)
    circle = BearingGrid.of(binned, np.arange(0.0, 360.0, COARSE_DEG))
    return _posterior(
        alternatives,
        templates,
        grid,
        look,
        weight,
        (grid.cost(templates, weight), circle.bearing_deg, circle.cost(templates, weight)),
    )


def profile_minimum(curve: PatternCurve, binned: BinnedSweep, bearing_deg: float, noise_db: float | None) -> float:
    """The bearing within half a beam of `bearing_deg` that fits best at its own best level, on a 0.5 degree grid.

    The cost has several feet when few slices fall into the beam; the descent that follows finds only the nearest.
    """
    reach = round(curve.beam_deg / 2.0 / _STEP_DEG)
    grid = bearing_deg + _STEP_DEG * np.arange(-reach, reach + 1)
    gain = curve.gain_db(np.subtract.outer(grid, binned.heading_deg[binned.filled]))
    power = binned.power_db[binned.filled]
    count = binned.count[binned.filled].astype(np.float64)
    level = np.sum((power - gain) * count, axis=1) / count.sum()
    if noise_db is not None:
        # the level that the strongest bins show, so that bins at the noise floor do not pull it up
        near = gain > gain.max(axis=1, keepdims=True) - 6.0
        level = np.sum((power - gain) * near * count, axis=1) / np.sum(near * count, axis=1)
    noise = 0.0 if noise_db is None else 10.0 ** (noise_db / 10.0)
    predicted = _DB * np.log(10.0 ** ((level[:, None] + gain) / 10.0) + noise)
    return float(grid[int(np.argmin(np.sum((power - predicted) ** 2 * count, axis=1)))])


def _weights(look: Look) -> NDArray[np.float64]:
    """(n,) inverse variances 1 / (e^2 + (f s)^2) with the likeliest e and f, times Huber's weights."""
    residual, share = look.residual_db, look.share
    scale = max(_standard_deviation(residual), 0.05)
    even, fading = (scale * _SD_GRID)[:, None, None], (scale * _FADING_GRID)[None, :, None]
    variance = even**2 + (fading * share) ** 2
    # -2 log likelihood, residuals cut at HUBER standard deviations
    unlikely = np.sum(np.log(variance) + np.minimum(residual**2 / variance, HUBER**2), axis=2)
    unlikely[:, 1:] += _FADING_EVIDENCE
    i, j = divmod(int(np.argmin(unlikely)), _FADING_GRID.size)
    likeliest = variance[i, j]
    size = np.abs(residual) / np.sqrt(likeliest)
    return np.minimum(1.0, HUBER / np.maximum(size, 1e-12)) / likeliest


def _posterior(
    alternatives: Alternatives,
    templates: Templates,
    grid: BearingGrid,
    look: Look,
    weight: NDArray[np.float64],
    costs: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
) -> Refined:
    """costs: (k, j) on the grid; (72,) bearings all round and (k, 72) there."""
    from scipy.interpolate import CubicSpline  # a seventh of a server's start, and only sweeps need it

    shape, turn = _alike(grid.heading_deg, look, weight)
    cost, around_deg, cost_around = costs
    least = cost.min(axis=1, keepdims=True)
    score = alternatives.log_prior[:, None]
    score = score - 0.5 * max(grid.size / max(shape, turn), FEWEST_FREE) * np.log(least)
    by_bearing = 0.5 * max(grid.size / turn, FEWEST_FREE)
    all_round = score - by_bearing * np.log(cost_around / least)
    score = score - by_bearing * np.log(cost / least)
    kept = np.flatnonzero(score.max(axis=1) > score.max() - NEGLIGIBLE)
    off = grid.bearing_deg - grid.bearing_deg[0]
    fine = np.arange(0.0, off[-1] + 1e-9, _FINE_DEG)
    mass = np.exp(CubicSpline(off, score[kept].T)(fine) - score.max())
    density = CircleDensity(
        around_deg,
        np.log(np.sum(np.exp(all_round - score.max()), axis=0) + LEAST_DENSITY),
        grid.bearing_deg[0] + fine,
        np.log(mass.sum(axis=1) + LEAST_DENSITY),
    )
    mass /= mass.sum()
    kinds = tuple(float(mass[:, alternatives.kind[kept] == kind].sum()) for kind in range(KINDS))
    likeliest = mass[:, alternatives.kind[kept] == int(np.argmax(kinds))].sum(axis=1)
    bearing = float(likeliest @ fine / likeliest.sum())
    spread = math.sqrt(float(mass.sum(axis=1) @ (fine - bearing) ** 2))
    k, place = divmod(int(np.argmax(score)), score.shape[1])
    shift_db = grid.look(templates, k, place, weight).shift_db
    return Refined(
        float(grid.bearing_deg[0] + bearing) % 360.0,
        math.hypot(spread, SIGMA_FLOOR_DEG),
        templates.level_db + shift_db,
        _drawn(templates, k, float(grid.bearing_deg[place]), shift_db),
        kinds,
        density,
    )


def _alike(heading_deg: NDArray[np.float64], look: Look, weight: NDArray[np.float64]) -> tuple[float, float]:
    """(r, q) of the module's docstring, each at least 1."""
    z, turn = look.residual_db * np.sqrt(weight), look.slope * np.sqrt(weight)
    apart = np.abs((heading_deg[:, None] - heading_deg[None, :] + 180.0) % 360.0 - 180.0)
    kernel = np.maximum(1.0 - apart / CORRELATION_DEG, 0.0)
    squares, steep = max(float(z @ z), 1e-12), max(float(turn @ turn), 1e-12)
    shape = float(np.einsum("i,ij,j", z, kernel, z)) / squares
    # autocorrelation by lag, of the bins that turn the bearing
    lag = np.minimum(np.rint(apart / BIN_DEG), CORRELATION_DEG / BIN_DEG).astype(np.int64)
    pair = np.abs(np.outer(turn, turn))
    covariance = np.bincount(lag.ravel(), (np.outer(z, z) * pair).ravel())
    rho = covariance / np.maximum(np.bincount(lag.ravel(), pair.ravel()), 1e-12)
    rho = rho / max(float(rho[0]), 1e-12)
    correlated = float(np.einsum("i,ij,j", turn, rho[lag] * kernel, turn)) / steep
    uneven = float(turn**2 @ z**2) / steep * z.size / squares
    arc_deg = 360.0 * max(float(look.share.mean()), 1.0 / BINS)
    short = (1.0 + CORRELATION_DEG / arc_deg) / (1.0 + CORRELATION_DEG / 360.0)
    return max(shape, 1.0), max(correlated, 1.0) * max(uneven, 1.0) * short


def _level_db(curve: PatternCurve, binned: BinnedSweep, bearing_deg: float, noise_db: float | None) -> float:
    """The wave's power at the antenna's maximum: least squares in linear power, which the strong bins decide."""
    measured_db = binned.power_db[binned.filled]
    top_db = float(measured_db.max())
    noise = 0.0 if noise_db is None else 10.0 ** ((noise_db - top_db) / 10.0)
    gain = 10.0 ** ((curve.gain_db(bearing_deg - binned.heading_deg[binned.filled]) - curve.peak_db) / 10.0)
    power = float(gain @ (10.0 ** ((measured_db - top_db) / 10.0) - noise)) / float(gain @ gain)
    return top_db + 10.0 * math.log10(max(power, 1e-3))


def _drawn(templates: Templates, k: int, bearing_deg: float, shift_db: float) -> NDArray[np.float64]:
    """(180,) template k at the bins' centres."""
    at: NDArray[np.float64] = ((bearing_deg - (np.arange(BINS, dtype=np.float64) + 0.5) * BIN_DEG) % 360.0) / BIN_DEG
    low = np.floor(at).astype(np.int64) % BINS
    db, _, share = templates.between(k, low, at - np.floor(at))
    return db + share * shift_db


def _standard_deviation(residual: NDArray[np.float64]) -> float:
    """Of residuals with some outliers: from the median, but not far below the root mean square."""
    return max(1.4826 * float(np.median(np.abs(residual))), 0.75 * float(np.sqrt(np.mean(residual**2))))
