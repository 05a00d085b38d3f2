"""Planners that settle several bearings at a time."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np

from planner.belief.grid import GridBelief
from planner.types import Decision, FloatArray, Problem


class PlansAhead(ABC):
    """A policy whose whole route is meant to be flown before it is asked again; called, it gives the first place.

    what: the route in the operator's words, after "first of n".
    """

    __slots__ = ()
    what: ClassVar[str]

    @abstractmethod
    def route(self, problem: Problem, belief: GridBelief, platform: tuple[float, float]) -> FloatArray:
        """(n, 2) m: the places of the next n >= 1 bearings, in order."""

    def __call__(
        self,
        problem: Problem,
        belief: GridBelief,
        platform: tuple[float, float],
        rng: np.random.Generator | None = None,
    ) -> Decision:
        """The first place of the route. `rng` is not used."""
        route = self.route(problem, belief, platform)
        return Decision(float(route[0, 0]), float(route[0, 1]), reason=f"first of {len(route)} {self.what}")
