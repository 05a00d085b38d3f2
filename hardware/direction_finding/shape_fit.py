"""Shapes that a turn may have, at one level, against what was heard, from many bearings at once.

A shape is a template every 2 degrees of (bearing - heading); between two of them it is linear. Sums over the readings
become products of matrices: each reading's value is shared between the two places of the template next to it.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.alternatives import Alternatives
from hardware.direction_finding.sweep import BIN_DEG, BINS, BinnedSweep

LARGEST_SHIFT_DB = 6.0
SINGLE_THREAD = 2**18
"""Multiplications in a matrix product up to which OpenBLAS keeps to one thread."""
_DB = 10.0 / np.log(10.0)


class Templates:
    """The alternatives at one level. db: (k, 180) with noise. share: (k, 180) of the wave in the power, None: all."""

    def __init__(self, alternatives: Alternatives, level_db: float, noise_db: float | None) -> None:
        self.level_db = level_db
        power = alternatives.power * 10.0 ** (level_db / 10.0)
        if noise_db is None:
            self.db, self.share = _DB * np.log(power), None
        else:
            total = power + 10.0 ** (noise_db / 10.0)
            self.db, self.share = _DB * np.log(total), power / total

    def smoothed(self, bins: int) -> Templates:
        """The same templates averaged over `bins` neighbouring bins."""
        means = copy(self)
        means.db = box(self.db, bins)
        means.share = None if self.share is None else box(self.share, bins)
        return means

    def between(self, k: int, low: NDArray[np.int64], part: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
        """(n,) decibels, their slope a degree, and the wave's share at places low + part of template k."""
        high = (low + 1) % BINS
        db = self.db[k]
        share = np.ones(part.size) if self.share is None else _mix(self.share[k][low], self.share[k][high], part)
        return _mix(db[low], db[high], part), (db[high] - db[low]) / BIN_DEG, share


@dataclass(frozen=True, slots=True)
class Look:
    """The filled bins against one template at one bearing, its level fitted: by shift_db.

    residual_db, share: (n,); slope: (n,) dB a degree of bearing, what a change of level explains taken out.
    """

    residual_db: NDArray[np.float64]
    share: NDArray[np.float64]
    slope: NDArray[np.float64]
    shift_db: float


class BearingGrid:
    """The filled bins seen from (j,) bearings: template places b - h_i = (low + part) bins, both (n, j)."""

    def __init__(
        self, bearing_deg: NDArray[np.float64], heading_deg: NDArray[np.float64], power_db: NDArray[np.float64]
    ) -> None:
        self.bearing_deg = bearing_deg
        self.heading_deg = heading_deg
        self.power_db = power_db
        self.size = self.power_db.size
        at = (np.subtract.outer(bearing_deg, self.heading_deg).T % 360.0) / BIN_DEG
        self.low = np.floor(at).astype(np.int64) % BINS
        self.part = at - np.floor(at)

    @classmethod
    def of(cls, binned: BinnedSweep, bearing_deg: NDArray[np.float64]) -> BearingGrid:
        """The filled bins."""
        return cls(bearing_deg, binned.heading_deg[binned.filled], binned.power_db[binned.filled])

    def look(self, templates: Templates, k: int, place: int, weight: NDArray[np.float64]) -> Look:
        """Against template k from bearing number `place`, the level fitted with the (n,) weights."""
        db, slope, share = templates.between(k, self.low[:, place], self.part[:, place])
        # d(model) / d(level) = share
        leverage = weight * share / np.sum(weight * share**2)
        residual = self.power_db - db
        shift = float(leverage @ residual)
        steep = slope - share * float(leverage @ slope)
        return Look(residual - share * shift, share, steep, float(np.clip(shift, -LARGEST_SHIFT_DB, LARGEST_SHIFT_DB)))

    def cost(self, templates: Templates, weight: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, j) weighted sum of squares with the level profiled out, to first order in the level.

        sum w (m - T - L s)^2 over L = sum w (m - T)^2 - (sum w s (m - T))^2 / sum w s^2, for all at once by matrices.
        """
        m = self.power_db
        of_weight, of_power = self._spread(weight), self._spread(weight * m)
        db, share = templates.db, templates.share
        squares = (weight @ m**2) - 2.0 * product(db, of_power) + product(db**2, of_weight)
        if share is None:
            along = weight @ m - product(db, of_weight)
        else:
            along = product(share, of_power) - product(share * db, of_weight)
        return np.maximum(squares - along**2 / self.norm(templates, weight), 1e-6)

    def norm(self, templates: Templates, weight: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, j) sum w s^2: how well the readings know the level."""
        if templates.share is None:
            return np.full((1, 1), weight.sum())
        return np.maximum(product(templates.share**2, self._spread(weight)), 1e-9)

    def _spread(self, value: NDArray[np.float64]) -> NDArray[np.float64]:
        """(180, j) the bins' values at their places in the template, shared between the two next to them."""
        count = self.bearing_deg.size
        column = np.arange(count)
        spread = np.zeros(BINS * count)
        for place, part in ((self.low, 1.0 - self.part), ((self.low + 1) % BINS, self.part)):
            spread += np.bincount((place * count + column).ravel(), (value[:, None] * part).ravel(), BINS * count)
        return spread.reshape(BINS, count)


def product(left: NDArray[np.float64], right: NDArray[np.float64]) -> NDArray[np.float64]:
    """left @ right in blocks too small for BLAS to share among threads, which on a busy machine wait for each other."""
    rows = max(SINGLE_THREAD // right.size, 1)
    product = np.empty((left.shape[0], right.shape[1]))
    for first in range(0, left.shape[0], rows):
        np.matmul(left[first : first + rows], right, out=product[first : first + rows])
    return product


def _mix(low: NDArray[np.float64], high: NDArray[np.float64], part: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(low * (1.0 - part) + high * part, dtype=np.float64)


def box(values: NDArray[np.float64], bins: int) -> NDArray[np.float64]:
    """(k, 180) means over `bins` (odd) around each place, circular."""
    half = bins // 2
    total = np.cumsum(np.concatenate([values[:, -half - 1 :], values, values[:, :half]], axis=1), axis=1)
    return (total[:, bins:] - total[:, :-bins]) / bins
