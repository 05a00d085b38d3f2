"""Sums over the live cells about an estimate: the geometric median, and whether the expected RMSE is small enough."""

from __future__ import annotations

import numpy as np

from planner.compiling import jit
from planner.kernels.reference.belief import MEDIAN_STEPS, NEARLY

_CHUNK = 128


@jit
def geometric_median(weight, along, across, cells, ea, eb, tolerance):
    """A few steps of Weiszfeld's iteration towards the geometric median, from the mean."""
    for _ in range(MEDIAN_STEPS):
        pull = pull_a = pull_b = 0.0
        for i in range(cells):
            a, b = along[i], across[i]
            w = weight[i] / max(np.sqrt((a - ea) * (a - ea) + (b - eb) * (b - eb)), tolerance)
            pull += w
            pull_a += w * a
            pull_b += w * b
        ea, eb = pull_a / pull, pull_b / pull
    return ea, eb


@jit
def below_threshold(weight, along, across, cells, ea, eb, second_moment, m0, threshold, reach):
    """Whether the expected RMSE about (ea, eb) is below the threshold (4.11).

    E d <= sqrt(E d^2) and E d >= E d^2 / reach (no cell is farther) often decide; else the sum is taken until it does.
    """
    if second_moment < threshold * threshold * (1.0 - NEARLY):
        return True
    if second_moment >= threshold * reach:
        return False
    total, limit = 0.0, threshold * m0
    for first in range(0, cells, _CHUNK):
        total += distance_sum(weight, along, across, first, min(first + _CHUNK, cells), ea, eb)
        if total >= limit:
            return False
    return True


@jit
def distance_sum(weight, along, across, first, last, ea, eb):
    """Sum of weight times distance to (ea, eb) over the cells first <= i < last: metres times weight."""
    total = 0.0
    w, a, b = weight[first:last], along[first:last], across[first:last]
    for i in range(last - first):
        da, db = a[i] - ea, b[i] - eb
        total += w[i] * np.sqrt(da * da + db * db)
    return total
