"""Refinement between the columns: maximum likelihood of bearing and level on the binned decibels.

Noise of received power is multiplicative (fading, gain jitter), so it is even in decibels and the likelihood is a least
squares problem there:  m_i = 10 log10( sum_k a_k G(phi_k - h_i) + N ) + w_i,  w_i ~ N(0, s_i^2).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.sweep import BinnedSweep

LEAKAGES = (0.0, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3)
"""Stray power, of the strongest bin's, that no pattern explains; with it, decibels near a null say little."""
LEAKAGE_EVIDENCE = 4.0
"""Leakage is believed when it lowers -2 log likelihood by more than this."""
SMOOTHING_DEG = 1.0
HUBER = 3.0
"""Residuals beyond so many standard deviations count linearly, not quadratically."""
_DB = 10.0 / np.log(10.0)
_STEP_DEG = 0.5


@dataclass(frozen=True, slots=True)
class Fit:
    """A pattern fit with one or two sources.

    bearing_deg, level_db: (k,) sources, the strongest first. covariance: (2k, 2k) of (bearings in degrees, levels
    in dB), for the assumed spread. residual_db, predicted_db: (n,) of the filled bins. weight: (n,) their inverse
    variances. cost: weighted sum of squares, robust; about n when the assumed spread is right. scores: (n, 2k)
    w_i r_i d(model_i) / d(parameters).
    """

    bearing_deg: NDArray[np.float64]
    level_db: NDArray[np.float64]
    covariance: NDArray[np.float64]
    residual_db: NDArray[np.float64]
    predicted_db: NDArray[np.float64]
    weight: NDArray[np.float64]
    cost: float
    scores: NDArray[np.float64]


class PatternCurve:
    """Gain and its slope at any relative bearing from a table every 0.5 degrees (circular, linear in dB)."""

    def __init__(self, pattern: AntennaPattern) -> None:
        table = pattern.gain_at(np.arange(0.0, 360.0, _STEP_DEG))
        self._table = np.append(table, table[:1])
        rise = (np.roll(table, -1) - np.roll(table, 1)) / (2.0 * _STEP_DEG)
        self._rise = np.append(rise, rise[:1])
        self.peak_db = float(table.max())
        self.beam_deg = float(np.sum(table > self.peak_db - 3.0) * _STEP_DEG)

    def gain_db(self, relative_deg: NDArray[np.float64]) -> NDArray[np.float64]:
        return self._look_up(self._table, relative_deg)

    def slope_db_deg(self, relative_deg: NDArray[np.float64]) -> NDArray[np.float64]:
        return self._look_up(self._rise, relative_deg)

    @staticmethod
    def _look_up(table: NDArray[np.float64], relative_deg: NDArray[np.float64]) -> NDArray[np.float64]:
        place = (relative_deg % 360.0) / _STEP_DEG
        low = np.minimum(place.astype(np.int64), table.size - 2)
        part = place - low
        return table[low] * (1.0 - part) + table[low + 1] * part


def relative_weights(
    binned: BinnedSweep, predicted_db: NDArray[np.float64], noise_db: float | None, spread: Spread
) -> NDArray[np.float64]:
    """(n,) 1 dB^2 / variance of the filled bins' dB means.

    variance_i = sd^2 (1 + 1/count)/2 + (4.34 leakage P_max / P_i)^2 + (1.3 N / P_i)^2: samples in a bin share its
    fading; stray power and noise weigh most where the antenna is weak.
    """
    strength = 10.0 ** ((predicted_db - predicted_db.max()) / 10.0)
    variance = spread.sd_db**2 * (1.0 + 1.0 / binned.count[binned.filled]) / 2.0
    variance = variance + (_DB * spread.leakage / strength) ** 2
    if noise_db is not None:
        variance = variance + (0.3 * _DB * np.minimum(10.0 ** ((noise_db - predicted_db) / 10.0), 1.0)) ** 2
    return 1.0 / variance


@dataclass(frozen=True, slots=True)
class Spread:
    """How the bins scatter about the fit: sd_db everywhere, and stray power `leakage` (of the strongest bin's)."""

    sd_db: float = 1.0
    leakage: float = 0.0


def estimate_spread(residual_db: NDArray[np.float64], predicted_db: NDArray[np.float64]) -> Spread:
    """The likeliest Spread among LEAKAGES, given a fit's residuals (n,) and prediction (n,)."""
    strength = 10.0 ** ((predicted_db - predicted_db.max()) / 10.0)
    near_db = max(_standard_deviation(residual_db), 0.2)
    best, best_score = Spread(near_db), np.inf
    for leakage in LEAKAGES:
        stray = (_DB * leakage / strength) ** 2
        for sd_db in (0.25 * near_db, 0.5 * near_db, 0.7 * near_db, near_db, 1.4 * near_db):
            variance = sd_db**2 + stray
            # -2 log likelihood, residuals cut at HUBER standard deviations
            score = float(np.sum(np.log(variance) + np.minimum(residual_db**2 / variance, HUBER**2)))
            score += LEAKAGE_EVIDENCE if leakage > 0 else 0.0
            if score < best_score - 1e-9:
                best, best_score = Spread(sd_db, leakage), score
    return best


def fit_pattern(
    curve: PatternCurve,
    binned: BinnedSweep,
    start_bearing_deg: NDArray[np.float64],
    start_level_db: NDArray[np.float64],
    noise_db: float | None,
    spread: Spread,
    iterations: int = 25,
) -> Fit:
    """Levenberg-Marquardt with Huber weights from the given sources; works on the filled bins."""
    heading = binned.heading_deg[binned.filled]
    power = binned.power_db[binned.filled]
    noise = 0.0 if noise_db is None else 10.0 ** (noise_db / 10.0)
    sources = start_bearing_deg.size
    theta = np.concatenate([start_bearing_deg, start_level_db]).astype(np.float64)
    damping = 1e-3

    predicted, jacobian = _model(curve, heading, theta, sources, noise)
    residual = power - predicted
    weight = relative_weights(binned, predicted, noise_db, spread)
    limit = _huber_limit(residual, weight)
    robust = _huber(residual, weight, limit)
    cost = _cost(residual, weight, limit)
    for _ in range(iterations):
        normal = (jacobian * robust[:, None]).T @ jacobian
        step = _damped_step(normal, (jacobian * robust[:, None]).T @ residual, damping)
        step = np.clip(step, -10.0, 10.0)
        trial = theta + step
        trial_predicted, trial_jacobian = _model(curve, heading, trial, sources, noise)
        trial_cost = _cost(power - trial_predicted, weight, limit)
        if trial_cost <= cost:
            settled = np.abs(step[:sources]).max() < 0.003 or cost - trial_cost < 1e-7 * cost
            theta, jacobian, residual, cost = trial, trial_jacobian, power - trial_predicted, trial_cost
            robust = _huber(residual, weight, limit)
            damping = max(damping * 0.2, 1e-9)
            if settled:
                break
        else:
            damping *= 8.0
            if damping > 1e6:
                break
    normal = (jacobian * weight[:, None]).T @ jacobian
    covariance = np.asarray(np.linalg.pinv(normal, hermitian=True), dtype=np.float64)
    order = np.argsort(-theta[sources:], kind="stable")
    both = np.concatenate([order, order + sources])
    return Fit(
        theta[:sources][order] % 360.0,
        theta[sources:][order],
        covariance[np.ix_(both, both)],
        residual,
        power - residual,
        weight,
        cost,
        ((weight * residual)[:, None] * jacobian)[:, both],
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
    level = (power - gain) @ count / count.sum()
    if noise_db is not None:
        # the level that the strongest bins show, so that bins at the noise floor do not pull it up
        near = gain > gain.max(axis=1, keepdims=True) - 6.0
        level = np.sum((power - gain) * near * count, axis=1) / np.sum(near * count, axis=1)
    noise = 0.0 if noise_db is None else 10.0 ** (noise_db / 10.0)
    predicted = _DB * np.log(10.0 ** ((level[:, None] + gain) / 10.0) + noise)
    return float(grid[int(np.argmin((power - predicted) ** 2 @ count))])


def smooth_minimum(curve: PatternCurve, binned: BinnedSweep, fit: Fit, noise_db: float | None) -> Fit:
    """A single source's bearing at the foot of a parabola through the cost around it.

    A measured pattern is a polygon: its corners make small steps in the cost that the exact minimum would fall into.
    """
    heading = binned.heading_deg[binned.filled]
    noise = 0.0 if noise_db is None else 10.0 ** (noise_db / 10.0)
    off = np.linspace(-SMOOTHING_DEG, SMOOTHING_DEG, 9)
    relative = fit.bearing_deg[0] + np.subtract.outer(off, heading)
    predicted = _DB * np.log(10.0 ** ((fit.level_db[0] + curve.gain_db(relative)) / 10.0) + noise)
    residual = binned.power_db[binned.filled] - predicted
    level = residual @ fit.weight / fit.weight.sum()
    residual = residual - level[:, None]
    limit = _huber_limit(fit.residual_db, fit.weight)
    size = np.abs(residual) * np.sqrt(fit.weight)
    cost = np.sum(np.where(size <= limit, size**2, 2.0 * limit * size - limit**2), axis=1)
    second, first, _ = np.polyfit(off, cost, 2)
    if second <= 0.0:
        return fit
    step = float(np.clip(-first / (2.0 * second), -SMOOTHING_DEG, SMOOTHING_DEG))
    return replace(fit, bearing_deg=(fit.bearing_deg + step) % 360.0)


def _damped_step(normal: NDArray[np.float64], gradient: NDArray[np.float64], damping: float) -> NDArray[np.float64]:
    damped = normal.copy()
    damped.flat[:: normal.shape[0] + 1] *= 1.0 + damping
    damped.flat[:: normal.shape[0] + 1] += 1e-12
    return np.asarray(np.linalg.solve(damped, gradient), dtype=np.float64)


def _model(
    curve: PatternCurve, heading: NDArray[np.float64], theta: NDArray[np.float64], sources: int, noise: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(n,) dB and (n, 2k) derivative by bearings (per degree) and levels (per dB)."""
    total = np.full(heading.size, noise)
    parts: list[NDArray[np.float64]] = []
    for k in range(sources):
        # a_k G(phi_k - h_i)
        parts.append(10.0 ** ((theta[sources + k] + curve.gain_db(theta[k] - heading)) / 10.0))
        total = total + parts[-1]
    jacobian = np.empty((heading.size, 2 * sources))
    for k, part in enumerate(parts):
        share = part / total
        jacobian[:, k] = share * curve.slope_db_deg(theta[k] - heading)
        jacobian[:, sources + k] = share
    return _DB * np.log(total), jacobian


def _standard_deviation(scaled: NDArray[np.float64]) -> float:
    """Of residuals with some outliers: from the median, but not far below the root mean square."""
    return max(1.4826 * float(np.median(np.abs(scaled))), 0.75 * float(np.sqrt(np.mean(scaled**2))))


def _huber_limit(residual: NDArray[np.float64], weight: NDArray[np.float64]) -> float:
    """HUBER standard deviations of the weighted residuals, at least 2."""
    return max(HUBER * _standard_deviation(residual * np.sqrt(weight)), 2.0)


def _huber(residual: NDArray[np.float64], weight: NDArray[np.float64], limit: float) -> NDArray[np.float64]:
    size = np.abs(residual) * np.sqrt(weight)
    return weight * np.minimum(1.0, limit / np.maximum(size, 1e-12))


def _cost(residual: NDArray[np.float64], weight: NDArray[np.float64], limit: float) -> float:
    size = np.abs(residual) * np.sqrt(weight)
    return float(np.sum(np.where(size <= limit, size**2, 2.0 * limit * size - limit**2)))
