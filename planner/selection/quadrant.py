"""Quadrant search: a 3 x 3 lattice, then again and again the best of its four quadrants (thesis ch. 5)."""

from __future__ import annotations

import numpy as np

from planner.reasons import UnusableNumber
from planner.selection.continuous import PlacesResult, Rectangle, SamplePlaces, VisitedPlaces, paths_per_place
from planner.types import FloatArray, PlannerError


def quadrant_search(sample: SamplePlaces, rectangle: Rectangle, budget: int, *, levels: int = 4) -> PlacesResult:
    """N = R (9 + 5 L): nine places first, then five new ones in each of L levels, R paths for every place.

    A quadrant is judged by the mean over its four corners; its own 3 x 3 lattice shares these corners, so a level needs
    its centre and the middles of its sides only. The answer is the best place of all that were visited.
    """
    if levels < 0:
        raise PlannerError(UnusableNumber("levels", "not_negative", str(levels)))
    paths = paths_per_place(budget, 9 + 5 * levels)
    visited = VisitedPlaces(sample)
    xs = np.linspace(rectangle.x0, rectangle.x1, 3)
    ys = np.linspace(rectangle.y0, rectangle.y1, 3)
    values = visited.visit(_lattice(xs, ys).reshape(9, 2), 0, paths).reshape(3, 3)
    for _ in range(levels):
        corners = values[:-1, :-1] + values[1:, :-1] + values[:-1, 1:] + values[1:, 1:]
        j, i = np.unravel_index(np.argmin(corners), (2, 2))
        xs = np.linspace(float(xs[i]), float(xs[i + 1]), 3)
        ys = np.linspace(float(ys[j]), float(ys[j + 1]), 3)
        finer = np.full((3, 3), np.nan)
        finer[::2, ::2] = values[j : j + 2, i : i + 2]
        new = np.isnan(finer)
        finer[new] = visited.visit(_lattice(xs, ys)[new], 0, paths)
        values = finer
    return visited.result()


def _lattice(xs: FloatArray, ys: FloatArray) -> FloatArray:
    """(3, 3, 2) places, row j has y = ys[j]."""
    return np.stack(np.meshgrid(xs, ys), axis=-1)
