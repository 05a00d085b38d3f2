"""A Gaussian belief with an iterated extended Kalman update, for comparison with the grid (thesis 3.1.2, Fig. 3.4)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.observation import expected_bearing, validate_bearing, wrap
from planner.reasons import MeanAtSensor, UnusableGaussian
from planner.types import Bearing, FloatArray, PlannerError


@dataclass(frozen=True, slots=True, eq=False)
class GaussianBelief:
    """N(mean, covariance). mean: (2,) m ENU. covariance: (2, 2) m^2."""

    mean: FloatArray
    covariance: FloatArray

    def __post_init__(self) -> None:
        mean, covariance = np.array(self.mean, dtype=float), np.array(self.covariance, dtype=float)
        if mean.shape != (2,) or covariance.shape != (2, 2) or not np.isfinite(np.append(covariance, mean)).all():
            raise PlannerError(UnusableGaussian())
        if np.linalg.eigvalsh(covariance)[0] <= 0:
            raise PlannerError(UnusableGaussian())
        object.__setattr__(self, "mean", mean)
        object.__setattr__(self, "covariance", covariance)


def update(belief: GaussianBelief, bearing: Bearing, iterations: int = 20, tolerance: float = 1e-9) -> GaussianBelief:
    """The iterated EKF (Bell and Cathey 1993): Gauss-Newton steps on the posterior's negative logarithm.

    Each step linearizes at the last iterate, x+ = x0 + K (z - h(x) - H (x0 - x)), until it moves less than `tolerance`
    m. Outlier probability and further peaks of the bearing are not modelled. PlannerError when the iterate meets the
    sensor, where a bearing has no derivative.
    """
    validate_bearing(bearing)
    x = belief.mean
    for _ in range(max(1, iterations)):
        slope = _jacobian(x, bearing)
        gain = belief.covariance @ slope / (slope @ belief.covariance @ slope + bearing.sigma**2)
        residual = float(wrap(bearing.angle - expected_bearing(bearing.x, bearing.y, x[0], x[1])))
        following = belief.mean + gain * (residual - slope @ (belief.mean - x))
        moved = float(np.hypot(*(following - x)))
        x = following
        if moved < tolerance:
            break
    slope = _jacobian(x, bearing)
    gain = belief.covariance @ slope / (slope @ belief.covariance @ slope + bearing.sigma**2)
    keep = np.eye(2) - np.outer(gain, slope)
    covariance = keep @ belief.covariance @ keep.T + bearing.sigma**2 * np.outer(gain, gain)  # Joseph's form
    return GaussianBelief(x, covariance)


def _jacobian(x: FloatArray, bearing: Bearing) -> FloatArray:
    """d atan2(y - y_s, x - x_s) / d(x, y) = (-dy, dx) / r^2, (2,) rad/m."""
    dx, dy = x[0] - bearing.x, x[1] - bearing.y
    r2 = dx * dx + dy * dy
    if r2 == 0.0:
        raise PlannerError(MeanAtSensor())
    return np.array([-dy, dx]) / r2
