"""What the bearings of one flight are wrong by together: a compass that is off, an antenna that is mounted askew.

Two lines that are both off by d only cross elsewhere. From the third on, lines from different sides miss one another by
it. With places (e_i, n_i), an emitter at (e, n) and outliers as the belief has them, bearing i is

    z_i = atan2(e - e_i, n - n_i) + d + w_i,    w_i ~ (1 - eps) N(0, s_i^2) + eps / (2 pi)

and (e, n, d) the likeliest together, found by iteratively reweighted Gauss-Newton steps with Levenberg's damping from
several d. The standard error of d is that of the curvature there; it is large where places and emitter lie on one
circle (the danger circle of resection). Against outliers as the reason stands the likelihood without d. Among only
three bearings one that is wrong by little more than its sigma cannot be told from an offset of all.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FEWEST_BEARINGS = 3
SIGNIFICANT = 3.0
"""Standard errors."""
TOLERABLE_DEG = 5.0
"""Near enough to what a compass is usually off by."""
SIGMA_FLOOR = math.radians(1.0)
_STARTS = tuple(math.radians(d) for d in range(-45, 46, 15))
_STEPS = 40
_SETTLED = 1e-9
_NEAREST_M2 = 1.0


@dataclass(frozen=True, slots=True)
class HeadingOffset:
    """offset_deg: the bearings point so far clockwise of where they should. gain: 2 log likelihood ratio to none."""

    offset_deg: float
    std_error_deg: float
    gain: float

    @property
    def significant(self) -> bool:
        """Larger than a compass may be off by, than chance makes it, and than outliers explain."""
        size = abs(self.offset_deg)
        return size > max(TOLERABLE_DEG, SIGNIFICANT * self.std_error_deg) and self.gain > SIGNIFICANT**2


@dataclass(frozen=True, slots=True)
class _Fit:
    """x: east m, north m, offset rad. information: (3, 3) J' W J."""

    x: NDArray[np.float64]
    log_likelihood: float
    information: NDArray[np.float64]


def heading_offset(
    places_m: NDArray[np.float64],
    bearing_deg: NDArray[np.float64],
    sigma_deg: NDArray[np.float64],
    outlier_probability: float,
) -> HeadingOffset | None:
    """The common offset of bearings, None when fewer than three or none is determined.

    places_m: (k, 2) east, north. bearing_deg: (k,) clockwise from true north. sigma_deg: (k,) of what differs from
    bearing to bearing, the heading's common uncertainty left out. outlier_probability: of each bearing, above 0.
    """
    if len(bearing_deg) < FEWEST_BEARINGS:
        return None
    z, sigma = np.radians(bearing_deg), np.maximum(np.radians(sigma_deg), SIGMA_FLOOR)
    starts = [np.array([*_crossing(places_m, z - d), d]) for d in _STARTS]
    fits = [_likeliest(places_m, z, sigma, outlier_probability, x, 3) for x in starts]
    plain = [_likeliest(places_m, z, sigma, outlier_probability, x * (1.0, 1.0, 0.0), 2) for x in starts]
    best = max(fits, key=lambda fit: fit.log_likelihood)
    gain = 2.0 * (best.log_likelihood - max(fit.log_likelihood for fit in plain))
    try:
        variance = float(np.linalg.inv(best.information)[2, 2])
    except np.linalg.LinAlgError:
        return None
    if not variance > 0.0:
        return None
    return HeadingOffset(math.degrees(float(best.x[2])), math.degrees(math.sqrt(variance)), gain)


def _crossing(places_m: NDArray[np.float64], z: NDArray[np.float64]) -> NDArray[np.float64]:
    """(2,) the point nearest to all lines: cos(z_i) (e - e_i) = sin(z_i) (n - n_i), by least squares."""
    across = np.column_stack([np.cos(z), -np.sin(z)])
    return np.asarray(np.linalg.lstsq(across, np.sum(across * places_m, axis=1), rcond=None)[0], dtype=np.float64)


def _likeliest(
    places_m: NDArray[np.float64],
    z: NDArray[np.float64],
    sigma: NDArray[np.float64],
    outlier_probability: float,
    x: NDArray[np.float64],
    free: int,
) -> _Fit:
    """Uphill from `x` in its first `free` unknowns."""

    def look(at: NDArray[np.float64]) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
        """(log likelihood, (k,) residuals, (k,) weights: how probably each is no outlier, over its variance)."""
        off = at[:2] - places_m
        residual = np.remainder(z - np.arctan2(off[:, 0], off[:, 1]) - at[2] + np.pi, 2.0 * np.pi) - np.pi
        density = np.exp(-0.5 * (residual / sigma) ** 2) / (math.sqrt(2.0 * math.pi) * sigma)
        honest = (1.0 - outlier_probability) * density
        likelihood = honest + outlier_probability / (2.0 * math.pi)
        return float(np.log(likelihood).sum()), residual, honest / likelihood / sigma**2

    def slopes(at: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, 3) d(atan2(e, n) + d) / d(e, n, d) = n / r^2, -e / r^2, 1."""
        off = at[:2] - places_m
        square = np.maximum(np.sum(off**2, axis=1), _NEAREST_M2)
        return np.column_stack([off[:, 1] / square, -off[:, 0] / square, np.ones(z.size)])

    value, residual, weight = look(x)
    damping = 1e-3
    for _ in range(_STEPS):
        by = slopes(x)[:, :free]
        information = (by.T * weight) @ by
        damped = information + np.diag(damping * np.diag(information) + 1e-12)
        ahead = x.copy()
        ahead[:free] += np.linalg.solve(damped, by.T @ (weight * residual))
        there = look(ahead)
        risen = there[0] - value
        if risen < 0.0:
            damping *= 10.0
            continue
        x, (value, residual, weight) = ahead, there
        damping = max(damping / 5.0, 1e-9)
        if risen < _SETTLED:
            break
    by = slopes(x)
    return _Fit(x, value, (by.T * weight) @ by)
