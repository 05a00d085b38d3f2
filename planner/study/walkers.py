"""Emitters that move, as they do outside: a walk with turns, or a drift. Nothing here knows how a belief foresees it.

A walker goes at one pace and changes its direction by chance: the angle is a Brownian motion, whose pace of forgetting
is the walker's own. A drifter keeps its direction but for slow turns.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from planner.types import FloatArray

STEP_S = 1.0
Kind = Literal["walker", "drifter"]
FORGETS_S = (15.0, 60.0)
"""A walker's direction is forgotten after a time between these."""
DRIFTS_S = 1200.0


@dataclass(slots=True)
class Walker:
    """start: (2,) m, at the time 0. speed: m/s, all the time. forgets: s, e-folding time of the direction's
    correlation."""

    start: FloatArray
    speed: float
    forgets: float
    rng: np.random.Generator
    _way: list[FloatArray] = field(default_factory=list[FloatArray])
    _angle: float = 0.0

    def at(self, seconds: float) -> FloatArray:
        """(2,) m, at a time >= 0; the same however often and in which order it is asked."""
        if not self._way:
            self._way.append(self.start)
            self._angle = float(self.rng.uniform(0.0, 2.0 * np.pi))
        step, share = int(seconds // STEP_S), seconds / STEP_S % 1.0
        while len(self._way) < step + 2:
            direction = np.array([np.cos(self._angle), np.sin(self._angle)])
            self._way.append(self._way[-1] + self.speed * STEP_S * direction)
            # <cos(angle change)> = exp(-t / forgets) for variance 2 t / forgets
            self._angle += float(np.sqrt(2.0 * STEP_S / self.forgets) * self.rng.standard_normal())
        return (1.0 - share) * self._way[step] + share * self._way[step + 1]


def walker(kind: Kind, start: FloatArray, speed: float, rng: np.random.Generator) -> Walker:
    """Of its kind, with a temper of its own."""
    forgets = DRIFTS_S if kind == "drifter" else math.exp(rng.uniform(math.log(FORGETS_S[0]), math.log(FORGETS_S[1])))
    return Walker(start, speed, forgets, rng)
