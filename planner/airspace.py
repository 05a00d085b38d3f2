"""Where the platform may be at all; ways between such places are in `planner.travel`."""

from __future__ import annotations

import numpy as np

from planner.geometry import contains, contains_each
from planner.types import BoolArray, FloatArray, Problem


def may_fly(problem: Problem, places: FloatArray) -> BoolArray:
    """(n,) bool: inside the flight area and outside every no-fly area."""
    allowed = np.ones(len(places), dtype=bool)
    if problem.flight_area is not None:
        allowed &= contains(problem.flight_area, places)
    return allowed & ~contains_each(problem.no_fly, places).any(axis=0)
