"""How uncertain bearings are whose file does not say: from how they miss one another, where enough of them cross.

Bearing i, taken at (e_i, n_i), of an emitter at x: z_i = dir_i(x) + w_i, w_i ~ (1 - eps) N(0, s^2) + eps / 360. The
posterior of s and eps has the place integrated out on a grid:

    p(s, eps | z)  ~  p(s) p(eps) sum_x prod_i ( (1 - eps) N(z_i - dir_i(x); 0, s^2) + eps / 360 )

With one or two bearings nothing contradicts and the prior stays: log-normal about 15 degrees, between what fielded
rotating antennas show (7.5 degrees without those that are wrong altogether) and two people with hand-held ones did
(20; 173 bearings to collars at 50 known places, github.com/matteorizzuto/StoichHomeRanges, Data/*_ErrorReduction.csv).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

SIGMAS_DEG = np.geomspace(2.0, 45.0, 14)
TYPICAL_DEG = 15.0
TYPICAL_SPREAD = 0.6
"""Of the natural logarithm."""
OUTLIER_RATES = np.array([0.03, 0.1, 0.25])
OUTLIER_PRIOR = np.array([0.4, 0.4, 0.2])
_CELLS = 70


@dataclass(frozen=True, slots=True)
class BearingScatter:
    """sigma_deg: root of the posterior mean of s^2. outlier_probability: posterior mean of eps."""

    sigma_deg: float
    outlier_probability: float


def bearing_scatter(
    places_m: NDArray[np.float64],
    bearing_deg: NDArray[np.float64],
    low_m: NDArray[np.float64],
    high_m: NDArray[np.float64],
) -> BearingScatter:
    """places_m: (k, 2) east, north; bearing_deg: (k,) from true north; low_m, high_m: (2,) corners of the area."""
    east = np.tile(np.linspace(float(low_m[0]), float(high_m[0]), _CELLS), _CELLS)
    north = np.repeat(np.linspace(float(low_m[1]), float(high_m[1]), _CELLS), _CELLS)
    off_east = east[:, None] - places_m[:, 0]
    off_north = north[:, None] - places_m[:, 1]
    direction = np.degrees(np.arctan2(off_east, off_north))
    residual = (bearing_deg - direction + 180.0) % 360.0 - 180.0
    log_sigma = -0.5 * (np.log(SIGMAS_DEG / TYPICAL_DEG) / TYPICAL_SPREAD) ** 2
    score = np.empty((SIGMAS_DEG.size, OUTLIER_RATES.size))
    for i, sigma in enumerate(SIGMAS_DEG):
        density = np.exp(-0.5 * (residual / sigma) ** 2) / (math.sqrt(2.0 * math.pi) * sigma)
        for j, rate in enumerate(OUTLIER_RATES):
            by_place: NDArray[np.float64] = np.log((1.0 - rate) * density + rate / 360.0).sum(axis=1)
            top = float(by_place.max())
            score[i, j] = top + math.log(float(np.mean(np.exp(by_place - top)))) + math.log(OUTLIER_PRIOR[j])
    score = score + log_sigma[:, None]
    mass = np.exp(score - score.max())
    mass /= mass.sum()
    return BearingScatter(math.sqrt(float(mass.sum(axis=1) @ SIGMAS_DEG**2)), float(mass.sum(axis=0) @ OUTLIER_RATES))
