"""Planners that settle several bearings at a time."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np

from planner.belief.grid import GridBelief
from planner.types import Decision, FloatArray, Problem


@runtime_checkable
class PlansAhead(Protocol):
    """A policy whose whole route is meant to be flown before it is asked again; called, it gives the first place."""

    def route(self, problem: Problem, belief: GridBelief, platform: tuple[float, float]) -> FloatArray:
        """(n, 2) m: the places of the next n >= 1 bearings, in order."""
        ...

    def __call__(
        self, problem: Problem, belief: GridBelief, platform: tuple[float, float], rng: np.random.Generator
    ) -> Decision: ...


def first_of(route: FloatArray, reason: str) -> Decision:
    return Decision(float(route[0, 0]), float(route[0, 1]), reason=reason)
