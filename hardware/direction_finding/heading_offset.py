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
class _Fits:
    """x: (m, 3) east m, north m, offset rad. log_likelihood: (m,). information: (m, 3, 3) J' W J."""

    x: NDArray[np.float64]
    log_likelihood: NDArray[np.float64]
    information: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class _Climb:
    """Where m climbers are after a step: x as in _Fits, value: (m,) log likelihood there, residual, weight: (m, k),
    damping: (m,) Levenberg's, climbing: (m,) whether each still rises."""

    x: NDArray[np.float64]
    value: NDArray[np.float64]
    residual: NDArray[np.float64]
    weight: NDArray[np.float64]
    damping: NDArray[np.float64]
    climbing: NDArray[np.bool_]


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
    starts = np.array([[*_crossing(places_m, z - d), d] for d in _STARTS])
    with_offset = np.repeat([True, False], len(starts))
    x = np.vstack([starts, starts * np.array([1.0, 1.0, 0.0])])
    fits = _likeliest(places_m, z, sigma, outlier_probability, x, with_offset)
    best = int(np.argmax(fits.log_likelihood[: len(starts)]))
    gain = 2.0 * float(fits.log_likelihood[best] - fits.log_likelihood[~with_offset].max())
    try:
        variance = float(np.linalg.inv(fits.information[best, :, :])[2, 2])
    except np.linalg.LinAlgError:
        return None
    if not variance > 0.0:
        return None
    return HeadingOffset(math.degrees(float(fits.x[best, 2])), math.degrees(math.sqrt(variance)), gain)


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
    with_offset: NDArray[np.bool_],
) -> _Fits:
    """Uphill from all m starts `x` (m, 3) at once. with_offset: (m,) of the others it stays as it is."""

    def look(at: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """(m,) log likelihood, (m, k) residuals, (m, k) weights: how probably each is no outlier, over its variance."""
        off = at[:, None, :2] - places_m
        residual = np.remainder(z - np.arctan2(off[..., 0], off[..., 1]) - at[:, 2:] + np.pi, 2.0 * np.pi) - np.pi
        density = np.exp(-0.5 * (residual / sigma) ** 2) / (math.sqrt(2.0 * math.pi) * sigma)
        honest = (1.0 - outlier_probability) * density
        likelihood = honest + outlier_probability / (2.0 * math.pi)
        return np.log(likelihood).sum(axis=1), residual, honest / likelihood / sigma**2

    def slopes(at: NDArray[np.float64]) -> NDArray[np.float64]:
        """(m, k, 3) d(atan2(e, n) + d) / d(e, n, d) = n / r^2, -e / r^2, 1."""
        off = at[:, None, :2] - places_m
        square = np.maximum(np.sum(off**2, axis=-1), _NEAREST_M2)
        return np.stack([off[..., 1] / square, -off[..., 0] / square, np.ones_like(square)], axis=-1)

    def step(at: _Climb) -> _Climb:
        """Each climber goes where its own quadric has its top, if that is no lower; else it will look nearer."""
        by = slopes(at.x) * free[:, None, :]
        information = _information(by, at.weight)
        diagonal: NDArray[np.float64] = np.einsum("mii->mi", information)
        damped = information + np.eye(3) * (at.damping[:, None] * diagonal + 1e-12 + (1.0 - free))[:, None, :]
        uphill: NDArray[np.float64] = np.einsum("mki,mk->mi", by, at.weight * at.residual)
        tried = at.x + np.linalg.solve(damped, uphill[..., None])[..., 0]
        value, residual, weight = look(tried)
        risen = value - at.value
        better = at.climbing & (risen >= 0.0)
        return _Climb(
            x=_rows(better, tried, at.x),
            value=_rows(better, value, at.value),
            residual=_rows(better, residual, at.residual),
            weight=_rows(better, weight, at.weight),
            damping=_rows(better, np.maximum(at.damping / 5.0, 1e-9), at.damping * 10.0),
            climbing=at.climbing & ~(better & (risen < _SETTLED)),
        )

    free = np.column_stack([np.ones((len(x), 2)), with_offset])
    at = _Climb(x, *look(x), damping=np.full(len(x), 1e-3), climbing=np.full(len(x), True))
    for _ in range(_STEPS):
        at = step(at)
        if not at.climbing.any():
            break
    return _Fits(at.x, at.value, _information(slopes(at.x), at.weight))


def _information(by: NDArray[np.float64], weight: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m, 3, 3) J' W J of the slopes (m, k, 3) and weights (m, k)."""
    return np.einsum("mki,mk,mkj->mij", by, weight, by)


def _rows(which: NDArray[np.bool_], new: NDArray[np.float64], old: NDArray[np.float64]) -> NDArray[np.float64]:
    """Those of `new` where `which` says so, else those of `old`."""
    return np.where(which.reshape(-1, *(1,) * (old.ndim - 1)), new, old)
