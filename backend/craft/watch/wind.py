"""Which wind the vehicle leans against: a belief over hypotheses, from attitude and speed over the ground.

A multicopter leans as its drag asks, and its drag points along the air that passes it: for a wind w and a velocity v

    push = (k1 + k2 |v - w|) (v - w)        push: the thrust's horizontal part per mass, m/s^2

with k1, k2 >= 0 of this vehicle, fitted for each hypothesis. A wind that fits badly at every k is not the one. Hovering
shows a direction only; two legs in different directions show the speed. What is old counts less: wind turns.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from backend.craft.endurance import winds
from planner.types import FloatArray

MEMORY_S = 120.0
GUST_S = 5.0
"""Readings nearer to each other than this are hardly two."""
PUSH_SIGMA_M_S2 = 0.1
"""What the attitude errs by at least: half a degree."""
STRAIGHT_M_S2 = 0.5
"""A vehicle that speeds up or brakes by more leans for that."""


@dataclass(slots=True)
class WindBelief:
    """Sums over the readings, old ones fading; `x1`, `x2` are the two terms of the formula without their k."""

    _seconds: float = 0.0
    _x11: FloatArray = field(default_factory=lambda: np.zeros(len(winds()[0])))
    _x12: FloatArray = field(default_factory=lambda: np.zeros(len(winds()[0])))
    _x22: FloatArray = field(default_factory=lambda: np.zeros(len(winds()[0])))
    _x1p: FloatArray = field(default_factory=lambda: np.zeros(len(winds()[0])))
    _x2p: FloatArray = field(default_factory=lambda: np.zeros(len(winds()[0])))
    _pp: float = 0.0

    def see(self, velocity: tuple[float, float], push: tuple[float, float], seconds: float) -> None:
        """A stretch flown at one velocity, `seconds` long. (east, north) m/s over the ground; m/s^2."""
        east, north = winds()
        air_east, air_north = velocity[0] - east, velocity[1] - north
        speed2 = air_east**2 + air_north**2
        along = air_east * push[0] + air_north * push[1]
        speed = np.sqrt(speed2)
        fade = float(np.exp(-seconds / MEMORY_S))
        self._seconds = fade * self._seconds + seconds
        self._x11 = fade * self._x11 + seconds * speed2
        self._x12 = fade * self._x12 + seconds * speed2 * speed
        self._x22 = fade * self._x22 + seconds * speed2 * speed2
        self._x1p = fade * self._x1p + seconds * along
        self._x2p = fade * self._x2p + seconds * along * speed
        self._pp = fade * self._pp + seconds * (push[0] ** 2 + push[1] ** 2)

    def weights(self) -> FloatArray:
        """(n,) of the hypotheses, summing to one; even while nothing was seen."""
        misfit = self._misfit()
        if self._seconds <= 0.0:
            return np.full(len(misfit), 1.0 / len(misfit))
        readings = self._seconds / GUST_S
        variance = max(float(misfit.min()) / self._seconds, PUSH_SIGMA_M_S2**2)
        likely = np.exp(-0.5 * readings * (misfit - misfit.min()) / self._seconds / variance)
        return likely / likely.sum()

    def _misfit(self) -> FloatArray:
        """(n,) least sum of |push - formula|^2 seconds over k1, k2 >= 0."""
        x11, x12, x22, x1p, x2p = self._x11, self._x12, self._x22, self._x1p, self._x2p
        tiny = 1e-12
        alone_1 = np.maximum(x1p, 0.0) ** 2 / np.maximum(x11, tiny)
        alone_2 = np.maximum(x2p, 0.0) ** 2 / np.maximum(x22, tiny)
        determinant = np.maximum(x11 * x22 - x12**2, tiny)
        k1, k2 = (x22 * x1p - x12 * x2p) / determinant, (x11 * x2p - x12 * x1p) / determinant
        both = np.where((k1 >= 0) & (k2 >= 0), k1 * x1p + k2 * x2p, 0.0)
        return np.maximum(self._pp - np.maximum(np.maximum(alone_1, alone_2), both), 0.0)
