"""Policies that plan a route of several bearings and fly all of it before they plan again (open loop)."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np

from planner.belief.grid import GridBelief
from planner.reasons import FirstOfRoute, RoutePlanner
from planner.types import Decision, FloatArray, Problem


class RoutePolicy(ABC):
    """Called as a policy, it gives the first place of its route.

    planner: its name in the reason of its decisions.
    """

    __slots__ = ()
    planner: ClassVar[RoutePlanner]

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
        return Decision(float(route[0, 0]), float(route[0, 1]), reason=FirstOfRoute(len(route), self.planner))
