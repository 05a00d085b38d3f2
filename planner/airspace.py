"""Where the platform may be at all; ways between such places are in `planner.travel`."""

from __future__ import annotations

import numpy as np

from planner.geometry import contains
from planner.types import BoolArray, FloatArray, Problem


def may_fly(problem: Problem, places: FloatArray) -> BoolArray:
    """(n,) bool: inside the flight area and outside every no-fly area."""
    allowed = np.ones(len(places), dtype=bool)
    if problem.flight_area is not None:
        allowed &= contains(problem.flight_area, places)
    for ring in problem.no_fly:
        allowed &= ~contains((ring,), places)
    return allowed
