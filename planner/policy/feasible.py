"""From the place that a formula asks for to the nearest feasible action: one the platform may measure from."""

from __future__ import annotations

import numpy as np

from planner.airspace import may_fly
from planner.belief.estimate import confidence_region
from planner.belief.grid import GridBelief
from planner.geometry import distance_to_convex
from planner.policy.actions import constrained_actions, standoff_from
from planner.types import FloatArray, Problem


def nearest_feasible(problem: Problem, belief: GridBelief, place: FloatArray) -> FloatArray:
    """`place` (2,), m, itself where it may be flown to and keeps the standoff, else the nearest allowed action."""
    wanted = np.asarray(place, dtype=np.float64)
    standoff = standoff_from(belief, problem)
    clear = standoff <= 0 or distance_to_convex(wanted[None], confidence_region(belief))[0] >= standoff
    if clear and may_fly(problem, wanted[None])[0]:
        return wanted
    places = constrained_actions(problem, belief)
    return places[np.argmin(np.hypot(*(places - wanted).T))]
