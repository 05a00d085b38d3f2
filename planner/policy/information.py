"""Fisher information about the target's place, 1/m^2: what one bearing tells (3.77), what the belief knows."""

from __future__ import annotations

import numpy as np

from planner.types import Estimate, FloatArray


def bearing_gradient(relative: FloatArray, r2: FloatArray) -> FloatArray:
    """(..., 2) g = (-y, x) / r^2, 1/m, of bearings to targets at (..., 2) `relative` to the sensor; r2: (...) m^2."""
    return np.stack([-relative[..., 1], relative[..., 0]], axis=-1) / r2[..., None]


def bearing_information(places: FloatArray, target: FloatArray, sigma: float, nearest: float) -> FloatArray:
    """(..., 2, 2) J of one bearing from each of (..., 2) places to the target, ranges below `nearest` m count as it."""
    relative = target - places
    g = bearing_gradient(relative, np.maximum((relative**2).sum(axis=-1), nearest**2))
    return g[..., :, None] * g[..., None, :] / sigma**2


def prior_information(estimated: Estimate) -> FloatArray:
    """(2, 2) P^-1, finite for a belief without width too."""
    return np.asarray(np.linalg.inv(estimated.covariance + 1e-9 * np.eye(2)), dtype=np.float64)
