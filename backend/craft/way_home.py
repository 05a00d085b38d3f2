"""The way home: around what may not be flown over, inside the fence, from wherever the vehicle is. Pure.

Metres ENU; home is the origin. A vehicle that is where it may not be leaves by the nearest place where it may.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise

import numpy as np

from planner.travel import straight_suffices, way_back
from planner.types import PlannerError, Problem

ABOVE_HOME_M = 6.0
"""A vehicle nearer to home than this is above it and only has to land."""
NEAR_M, KEPT = 4.0, 64
"""Lengths of ways are kept, for places so near to each other: they are asked for several times a second."""

Point2 = tuple[float, float]


def way_home(problem: Problem, at: Point2) -> tuple[Point2, ...] | None:
    """Way points after `at`, home included; None when there is no way."""
    try:
        way = way_back(problem, np.array(at), np.zeros(2), ABOVE_HOME_M)
    except PlannerError:
        return None
    return tuple((float(x), float(y)) for x, y in way[1:])


def legs_home(problem: Problem, at: Point2) -> tuple[Point2, ...]:
    """(east, north) m of each leg home from within NEAR_M of `at`, none above home.

    Straight where there is no way: so the autopilot returns.
    """
    if math.hypot(*at) < ABOVE_HOME_M:
        return ()
    if straight_suffices(problem):
        return ((-at[0], -at[1]),)
    return _legs(_Ways(problem), (NEAR_M * round(at[0] / NEAR_M), NEAR_M * round(at[1] / NEAR_M)))


class _Ways:
    """A problem told from others by identity: it stays the same for a mission."""

    __slots__ = ("problem",)

    def __init__(self, problem: Problem) -> None:
        self.problem = problem

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Ways) and other.problem is self.problem

    def __hash__(self) -> int:
        return id(self.problem)


@lru_cache(KEPT)
def _legs(ways: _Ways, at: Point2) -> tuple[Point2, ...]:
    points = [at, *(way_home(ways.problem, at) or ((0.0, 0.0),))]
    return tuple((b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points))
