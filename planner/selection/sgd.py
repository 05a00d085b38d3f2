"""Stochastic gradient descent on the place of the next measurement (thesis ch. 5)."""

from __future__ import annotations

import math

import numpy as np

from planner.reasons import BudgetTooSmall
from planner.selection.continuous import PlacesResult, Rectangle, SamplePlaces, VisitedPlaces
from planner.types import PlannerError

DIFFERENCE = 20.0  # m between the two places of a finite difference
FIRST_STEP = 20.0  # m
DECAY = 4.0  # the last step is exp(-4) of the first


def step_length(iteration: int, iterations: int) -> float:
    """20 exp(-4 (l - 1) / (L - 1)), m, for l = 1 .. L."""
    return FIRST_STEP * math.exp(-DECAY * (iteration - 1) / max(iterations - 1, 1))


def sgd(
    sample: SamplePlaces, rectangle: Rectangle, start: tuple[float, float], budget: int, *, paths: int = 8
) -> PlacesResult:
    """From `start` (the base policy's action), L = floor((N - R) / 4R) steps against the direction of the gradient.

    Each step spends four evaluations of R = `paths` new sample paths, the same for its four places; R more value the
    place where it ends, which is the answer.
    """
    iterations = (budget - paths) // (4 * paths)
    if paths < 1 or iterations < 1:
        raise PlannerError(BudgetTooSmall(budget, 5 * max(paths, 1)))
    half = DIFFERENCE / 2
    stencil = np.array([[half, 0.0], [-half, 0.0], [0.0, half], [0.0, -half]])
    visited = VisitedPlaces(sample)
    place = rectangle.clip(np.array([start], dtype=np.float64))
    done = 0
    for iteration in range(1, iterations + 1):
        looked_at = rectangle.clip(place + stencil)
        values = visited.visit(looked_at, done, done + paths)
        done += paths
        width = np.maximum(np.array([looked_at[0, 0] - looked_at[1, 0], looked_at[2, 1] - looked_at[3, 1]]), 1e-9)
        gradient = np.array([values[0] - values[1], values[2] - values[3]]) / width
        norm = float(np.hypot(*gradient))
        if not math.isfinite(norm):
            raise ValueError("gradient descent came upon a place of infinite cost: use a discrete selection instead")
        if norm > 0:
            place = rectangle.clip(place - step_length(iteration, iterations) * gradient / norm)
    visited.visit(place, done, done + paths)
    return visited.result(best=len(visited) - 1)
