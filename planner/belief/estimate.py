"""What a belief says: point estimate, covariance, expected RMSE, entropy, confidence region.

Point estimates: maximum a posteriori (4.18), expected value, geometric median. The geometric median minimizes the
expected RMSE (3.58), it is found by Weiszfeld's iteration.
"""

from __future__ import annotations

import numpy as np

from planner.belief import compiled_estimate
from planner.belief.grid import GridBelief, smallest_set
from planner.geometry import cells_hull, centres
from planner.options import Estimator
from planner.types import Estimate, FloatArray, Ring

TIE_BITS = 20
"""Weights are compared by their leading 64 - 20 bits (2e-10 relative): rounding must not decide between equal cells."""

HEAVY_POINTS = 8
"""So many of the heaviest points are tried as the geometric median."""

MEDIAN_STEPS = 100


def estimate(belief: GridBelief, estimator: Estimator) -> Estimate:
    """Point estimate with its spread.

    With `map`, the expected value is used until the second bearing on a flat prior (spec 2): one wedge has no mode.
    """
    mass, x, y = _support(belief)
    px, py = _point(mass, x, y, estimator, belief)
    dx, dy = x - px, y - py
    xx, xy, yy = ((mass * product).sum() for product in (dx * dx, dx * dy, dy * dy))
    covariance = np.array([[xx, xy], [xy, yy]])  # (3.34)
    expected_rmse = float((mass * np.hypot(dx, dy)).sum())  # (3.58)
    cells = belief.density[belief.density > 0]
    return Estimate(px, py, covariance, expected_rmse, entropy=float(-(cells @ np.log(cells))))  # (3.59)


def most_likely(mass: FloatArray) -> int:
    """Index of the largest of (n,) weights; of equal ones (to 2e-10) the first."""
    keys = np.ascontiguousarray(mass, dtype=float).view(np.int64) >> TIE_BITS
    return int(np.argmax(keys))


def geometric_median(mass: FloatArray, x: FloatArray, y: FloatArray, tolerance: float) -> tuple[float, float]:
    """The point with the least mean distance, by Weiszfeld's iteration from the mean until a step < tolerance (m).

    The iteration is slow where the median is one of the heavy points: the heaviest are tried besides.
    """
    heaviest = np.argsort(-mass, kind="stable")[:HEAVY_POINTS]
    return compiled_estimate.geometric_median(mass, x, y, heaviest, tolerance, MEDIAN_STEPS)


def confidence_region(belief: GridBelief, share: float = 0.95) -> Ring:
    """Convex hull (n, 2), m ENU, of the smallest set of cells that holds `share` of the mass (6.2.1); of an even
    belief, which has no cell that it could leave out, of all."""
    cells = smallest_set(belief, share)
    densest = belief.density.max()
    if belief.density[cells].min() == densest:
        cells = belief.density == densest
    return cells_hull(cells, belief.x0, belief.y0, belief.h)


def mass_within(belief: GridBelief, x: float, y: float, radius: float) -> float:
    """Probability that the target is within `radius` m of (x, y), by cell centres."""
    cx, cy = np.meshgrid(*belief.centres())
    return float(belief.density[np.hypot(cx - x, cy - y) <= radius].sum())


def radius_of(belief: GridBelief, x: float, y: float, share: float) -> float:
    """m, the least within which of (x, y) the target is with probability `share`, by cell centres."""
    rows, columns = np.nonzero(belief.density)
    cx, cy = belief.centres()
    off = np.hypot(cx[columns] - x, cy[rows] - y)
    order = np.argsort(off)
    within = np.cumsum(belief.density[rows, columns][order])
    return float(off[order[min(int(np.searchsorted(within, share)), len(off) - 1)]])


def _support(belief: GridBelief) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mass, x, y of the cells with mass, blocks of copies taken as the one cell they came from, in row order."""
    k = belief.copies
    density, h = belief.density[::k, ::k] * float(k * k), belief.h * k
    rows, columns = np.nonzero(density)
    x, y = centres(belief.x0, h, density.shape[1]), centres(belief.y0, h, density.shape[0])
    return density[rows, columns], x[columns], y[rows]


def _point(
    mass: FloatArray, x: FloatArray, y: FloatArray, estimator: Estimator, belief: GridBelief
) -> tuple[float, float]:
    if estimator == "geometric_median":
        return geometric_median(mass, x, y, tolerance=1e-3 * belief.h)
    one_wedge = belief.flat_prior and belief.bearings <= 1
    if estimator == "expected_value" or one_wedge:
        return float(mass @ x), float(mass @ y)
    best = most_likely(mass)
    return float(x[best]), float(y[best])
