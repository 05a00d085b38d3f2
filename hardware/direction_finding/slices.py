"""A turn in slices of 10 degrees, and the noise in them: what hypotheses of a whole sweep are weighed with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.sweep import BINS, BinnedSweep

SLICES = 36
PER_SLICE = BINS // SLICES
NOISE_DB = np.array([0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0])
_NOISE_SPREAD = 0.5
"""Of the noise's natural logarithm about 1 dB."""
_NOISE_WEIGHTS = np.exp(-0.5 * (np.log(NOISE_DB) / _NOISE_SPREAD) ** 2)
LOG_NOISE_PRIOR = np.log(_NOISE_WEIGHTS / _NOISE_WEIGHTS.sum())


@dataclass(frozen=True, slots=True)
class Slices:
    """heading_deg, power_db: (n,) means. smooth: the slices are 10 degrees of several bins each."""

    heading_deg: NDArray[np.float64]
    power_db: NDArray[np.float64]
    smooth: bool


def slices_of(binned: BinnedSweep, bin_db: NDArray[np.float64]) -> Slices:
    """The (180,) bins as they are where few are filled, else their means over 10 degrees."""
    filled = binned.filled
    if int(filled.sum()) <= SLICES:
        return Slices(binned.heading_deg[filled], bin_db[filled], smooth=False)
    owner = np.arange(BINS)[filled] // PER_SLICE
    count = np.bincount(owner, minlength=SLICES)
    kept = count > 0
    heading = np.bincount(owner, binned.heading_deg[filled], SLICES)[kept] / count[kept]
    return Slices(heading, np.bincount(owner, bin_db[filled], SLICES)[kept] / count[kept], smooth=True)


def log_sum(values: NDArray[np.float64], axis: int | None = None) -> NDArray[np.float64]:
    """log sum exp along an axis, or of all."""
    top = np.max(values, axis=axis, keepdims=True)
    total = np.log(np.sum(np.exp(values - top), axis=axis, keepdims=True)) + top
    return np.asarray(np.squeeze(total, axis=axis), dtype=np.float64)
