"""BFGS on deterministic sample paths: a quasi-Newton descent on the place of the next measurement (thesis ch. 5)."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
from scipy.optimize import minimize

from planner.reasons import BudgetTooSmall
from planner.selection.continuous import PlacesResult, Rectangle, SamplePlaces, VisitedPlaces
from planner.types import FloatArray, PlannerError


class _BudgetSpent(Exception):
    """Leaves scipy's loop, which has no budget of function values of its own that counts a gradient's."""


def bfgs(
    sample: SamplePlaces,
    rectangle: Rectangle,
    start: tuple[float, float],
    budget: int,
    *,
    paths: int = 8,
    difference: float = 20.0,
) -> PlacesResult:
    """Descend from `start` (the base policy's action) on the mean over the first `paths` paths, always the same ones.

    The value and its central differences (`difference`, m, between the two places) take five evaluations of `paths`
    rollouts. The objective is a step function of the place, so the difference must span several steps; the answer is
    the best place looked at, by then or when the budget is spent.
    """
    if paths < 1 or budget < 5 * paths:
        raise PlannerError(BudgetTooSmall(budget, 5 * max(paths, 1)))
    half = difference / 2
    stencil = np.array([[0.0, 0.0], [half, 0.0], [-half, 0.0], [0.0, half], [0.0, -half]])
    visited = VisitedPlaces(sample)

    def value_and_gradient(place: FloatArray) -> tuple[float, FloatArray]:
        if (len(visited) + len(stencil)) * paths > budget:
            raise _BudgetSpent
        values = visited.visit(rectangle.clip(place + stencil), 0, paths)
        return float(values[0]), np.array([values[1] - values[2], values[3] - values[4]]) / difference

    with suppress(_BudgetSpent):
        minimize(value_and_gradient, rectangle.clip(np.array(start, dtype=np.float64)), jac=True, method="BFGS")
    return visited.result()
