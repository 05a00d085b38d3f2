"""Two plainer direction finders, for comparison: least-squares pattern fit and correlation."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.estimate import MINIMUM_QUALITY, cosine_quality, linear_power, refused, unusable
from hardware.direction_finding.refine import PatternCurve
from hardware.direction_finding.sweep import BIN_DEG, BINS, BinnedSweep, bin_sweep
from hardware.readings import BearingReading, Sweep
from hardware.reasons.sweep import UnlikeAntenna

_GRID_DEG = 0.5

Fit = tuple[float, float, float]
"""(bearing, its sigma, both in degrees; power in dB of the source where the pattern's gain is 0 dB)."""


@dataclass(frozen=True, slots=True)
class LeastSquaresDirectionFinder:
    """min over bearing and level of sum_i (m_i - level - G(bearing - h_i))^2 in decibels: one source, even noise."""

    minimum_quality: float = MINIMUM_QUALITY

    def estimate(self, sweep: Sweep, pattern: AntennaPattern) -> BearingReading:
        """sigma from the misfit's curvature; a sweep that cannot be used gives a refused reading."""
        return _reading(self.minimum_quality, sweep, pattern, self._fit)

    def _fit(self, binned: BinnedSweep, curve: PatternCurve, noise_db: float | None) -> Fit:
        heading, power = binned.heading_deg[binned.filled], binned.power_db[binned.filled]
        count = binned.count[binned.filled].astype(np.float64)

        def misfit(bearing: NDArray[np.float64]) -> NDArray[np.float64]:
            residual = power - curve.gain_db(np.subtract.outer(bearing, heading))
            level = residual @ count / count.sum()
            return ((residual - level[:, None]) ** 2) @ count

        bearing, curvature, least = _minimum(misfit)
        freedom = max(heading.size - 2, 1)
        # sigma^2 = residual variance / (half the second derivative)
        sigma = math.sqrt(max(least, 1e-9) / count.mean() / freedom / max(curvature / 2.0 / count.mean(), 1e-9))
        return bearing, sigma, float((power - curve.gain_db(bearing - heading)) @ count / count.sum())


@dataclass(frozen=True, slots=True)
class CorrelationDirectionFinder:
    """The bearing whose shifted pattern is most like the sweep: cosine similarity of linear powers."""

    minimum_quality: float = MINIMUM_QUALITY

    def estimate(self, sweep: Sweep, pattern: AntennaPattern) -> BearingReading:
        """sigma from the distance's curvature; a sweep that cannot be used gives a refused reading."""
        return _reading(self.minimum_quality, sweep, pattern, self._fit)

    def _fit(self, binned: BinnedSweep, curve: PatternCurve, noise_db: float | None) -> Fit:
        heading = binned.heading_deg[binned.filled]
        measured = linear_power(binned, noise_db)[binned.filled]
        measured = measured / max(float(np.linalg.norm(measured)), 1e-12)

        def distance(bearing: NDArray[np.float64]) -> NDArray[np.float64]:
            shifted = 10.0 ** (curve.gain_db(np.subtract.outer(bearing, heading)) / 10.0)
            # |a - b|^2 of unit vectors: 2 - 2 cos
            return 2.0 - 2.0 * (shifted @ measured) / np.linalg.norm(shifted, axis=1)

        bearing, curvature, least = _minimum(distance)
        sigma = math.sqrt(max(least, 1e-9) / max(heading.size - 2, 1) / max(curvature / 2.0, 1e-12))
        return bearing, sigma, float(np.median(binned.power_db[binned.filled] - curve.gain_db(bearing - heading)))


def _minimum(cost: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> tuple[float, float, float]:
    """(bearing in degrees, second derivative a square degree, least cost): grid, then a parabola through its foot."""
    grid = np.arange(0.0, 360.0, _GRID_DEG)
    coarse = cost(grid)
    foot = float(grid[int(np.argmin(coarse))])
    reach = 1.0
    fine: NDArray[np.float64] = foot + np.linspace(-reach, reach, 9)
    second, first, zeroth = np.polyfit(fine - foot, cost(fine), 2)
    step = float(np.clip(-first / (2.0 * second), -reach, reach)) if second > 1e-12 else 0.0
    return (foot + step) % 360.0, max(2.0 * float(second), 0.0), float(zeroth - second * step**2)


def _reading(
    minimum_quality: float,
    sweep: Sweep,
    pattern: AntennaPattern,
    fit: Callable[[BinnedSweep, PatternCurve, float | None], Fit],
) -> BearingReading:
    binned = bin_sweep(sweep.heading_deg, sweep.power_db, pattern.offset_to_nose_deg)
    refusal = unusable(sweep, binned)
    if refusal is not None:
        return refused(binned, refusal)
    curve, noise_db = PatternCurve(pattern), sweep.noise_floor_db
    bearing, sigma, level_db = fit(binned, curve, noise_db)
    quality = cosine_quality(curve, binned, bearing, noise_db)
    accepted = quality >= minimum_quality
    centre: NDArray[np.float64] = np.linspace(0.5 * BIN_DEG, 360.0 - 0.5 * BIN_DEG, BINS)
    return BearingReading(
        bearing_deg=bearing % 360.0,
        sigma_deg=min(sigma, 180.0),
        quality=quality,
        accepted=accepted,
        reason=None if accepted else UnlikeAntenna(quality, minimum_quality),
        peaks=(),
        binned_db=binned.power_db,
        fitted_db=level_db + curve.gain_db(bearing - centre),
        snr_db=None if noise_db is None else level_db + curve.peak_db - noise_db,
    )
