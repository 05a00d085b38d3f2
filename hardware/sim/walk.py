"""How a simulated emitter goes about: legs of one direction each, with rests between them. It knows of no estimator.

An animal picks a direction, goes for a while, rests, and picks another not far from the last. What drifts goes on and
on and is turned slowly. Both are piecewise straight, so that the place at any time is a sum of legs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

Gait = Literal["animal", "walking", "drifting"]

LEG_S = {"animal": (8.0, 30.0), "walking": (60.0, 180.0), "drifting": (60.0, 120.0)}
REST_S = {"animal": (0.0, 10.0), "walking": (0.0, 5.0), "drifting": (0.0, 0.0)}
TURN_RAD = {"animal": 1.1, "walking": 0.7, "drifting": 0.15}
"""Standard deviation of the angle between two legs."""


@dataclass(slots=True)
class Walk:
    """speed_m_s: on the legs. began_s: by the world's clock; before it the emitter stands. The seed decides the way."""

    gait: Gait
    speed_m_s: float
    began_s: float
    seed: int
    _rng: np.random.Generator = field(init=False)
    _corners: list[tuple[float, float, float]] = field(init=False)
    _angle: float = field(init=False)

    def __post_init__(self) -> None:
        self._rng = np.random.default_rng([self.seed, 1515])
        self._angle = float(self._rng.uniform(0.0, 2.0 * math.pi))
        self._corners = [(0.0, 0.0, 0.0)]

    def way(self, at_s: float) -> tuple[float, float]:
        """(east, north) m from where it was when it began; the same in whatever order times are asked for."""
        since = max(0.0, at_s - self.began_s)
        while self._corners[-1][0] <= since:
            self._go_on()
        times, east, north = (np.array(column) for column in zip(*self._corners, strict=True))
        return float(np.interp(since, times, east)), float(np.interp(since, times, north))

    def _go_on(self) -> None:
        time, east, north = self._corners[-1]
        rest, leg = self._rng.uniform(*REST_S[self.gait]), self._rng.uniform(*LEG_S[self.gait])
        self._angle += float(self._rng.normal(0.0, TURN_RAD[self.gait]))
        gone = self.speed_m_s * leg
        if rest > 0.0:
            self._corners.append((time + rest, east, north))
        end = (time + rest + leg, east + gone * math.cos(self._angle), north + gone * math.sin(self._angle))
        self._corners.append(end)
