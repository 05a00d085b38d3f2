# pyright: standard
"""The geometric median of weighed points, compiled by numba, without the GIL: a hundred steps over all cells."""

from __future__ import annotations

import numpy as np

from planner.compiling import entry, jit
from planner.types import FloatArray, IntArray


@jit
def _mean_distance(mass, x, y, px, py):
    total = 0.0
    for i in range(len(mass)):
        dx, dy = x[i] - px, y[i] - py
        total += mass[i] * np.sqrt(dx * dx + dy * dy)
    return total


def geometric_median(
    mass: FloatArray, x: FloatArray, y: FloatArray, tried: IntArray, tolerance: float, steps: int
) -> tuple[float, float]:
    """The same as `estimate.geometric_median`, for points (n,) whose masses add up to 1, in at most `steps` steps.
    tried: (k,) indices of points to compare the result with; the first of equally good ones is taken."""
    mass, x, y = (np.ascontiguousarray(one, dtype=float) for one in (mass, x, y))
    px, py = _median(mass, x, y, tried, tolerance, steps)
    return float(px), float(py)


@entry
def _median(mass, x, y, tried, tolerance, steps):
    px = py = 0.0
    for i in range(len(mass)):
        px += mass[i] * x[i]
        py += mass[i] * y[i]
    for _step in range(steps):
        pull = pull_x = pull_y = 0.0
        for i in range(len(mass)):
            dx, dy = x[i] - px, y[i] - py
            weight = mass[i] / max(np.sqrt(dx * dx + dy * dy), tolerance)
            pull += weight
            pull_x += weight * x[i]
            pull_y += weight * y[i]
        qx, qy = pull_x / pull, pull_y / pull
        moved = np.hypot(qx - px, qy - py)
        px, py = qx, qy
        if moved < tolerance:
            break
    least = _mean_distance(mass, x, y, px, py)
    for i in tried:
        distance = _mean_distance(mass, x, y, x[i], y[i])
        if distance < least:
            least, px, py = distance, x[i], y[i]
    return px, py
