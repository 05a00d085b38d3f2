"""Where a bearing crosses those that were taken as widely as a claim asks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

MARGIN = 1.25
"""Over the least angle: the estimate moves with the bearing."""


@dataclass(frozen=True, slots=True, eq=False)
class Crossing:
    """x, y: of the estimate, m ENU. directions: (k,) rad ccw from east, to it from the places of the bearings that
    count. least: rad in [0, pi/2], the angle that is still missing."""

    x: float
    y: float
    directions: NDArray[np.float64]
    least: float

    def angles(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) rad in [0, pi/2]: the widest at which the line from each place (n, 2), m, crosses one that was taken."""
        here = np.arctan2(self.y - places[:, 1], self.x - places[:, 0])
        between = np.abs(here[:, None] - self.directions) % np.pi
        return np.minimum(between, np.pi - between).max(axis=1)

    def crossed_from(self, places: NDArray[np.float64]) -> NDArray[np.bool_]:
        """(n,) of places (n, 2), m: widely enough with a margin, or as widely as from any of them."""
        angles = self.angles(places)
        return np.asarray(angles >= min(MARGIN * self.least, angles.max(initial=0.0)))
