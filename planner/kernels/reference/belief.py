"""A belief on a grid inside a rollout: measure, clip, crop, multiply by the likelihood, take the estimate."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from planner.belief.estimate import TIE_BITS
from planner.belief.grid import COARSE_CELLS, FEWEST_CELLS, aligned_range
from planner.geometry import cells_hull, centres, clip_half_plane
from planner.kernels.model import GEOMETRIC_MEDIAN, LIKELIHOOD_POWER, MAP, Rules
from planner.observation import THINNEST, WEDGE_SIGMAS
from planner.types import FloatArray

NEARLY = 1e-9
CONFIDENCE = 0.95
HISTOGRAM_SHIFT = 48
"""Weights are counted in bins of 1/16 octave, the leading 16 bits of a double, to find the 95 % cells."""
HISTOGRAM_BINS = 512
MEDIAN_STEPS = 6
MEDIAN_REACH = 1.15
"""The geometric median is looked for where the expected RMSE about the mean is below this many times the threshold: it
brings no belief of one peak further down."""
DEEPEST_DOUBLING = 12


class Belief(NamedTuple):
    """weight: (ny, nx) unnormalized. doubled: the next bearing starts on half the cell size."""

    weight: FloatArray
    x0: float
    y0: float
    h: float
    hull: FloatArray
    bearings: int
    doubled: bool


class PointEstimate(NamedTuple):
    """The estimate of a belief and its spread (m, m^2)."""

    x: float
    y: float
    xx: float
    xy: float
    yy: float
    expected_rmse: float


def measure(belief: Belief, rules: Rules, place: FloatArray, target: FloatArray, noise: float) -> Belief:
    """The belief after the bearing z = atan2(y_t - y_s, x_t - x_s) + w from `place` (4.2).

    A bearing that leaves no mass (the target lay on the border of its cell) changes nothing but the count.
    """
    angle = np.arctan2(target[1] - place[1], target[0] - place[0]) + noise
    half = WEDGE_SIGMAS * rules.sigma
    to_left_of_right = np.array([-np.sin(angle - half), np.cos(angle - half)])
    to_right_of_left = np.array([np.sin(angle + half), -np.cos(angle + half)])
    hull = clip_half_plane(clip_half_plane(belief.hull, place, to_left_of_right), place, to_right_of_left)
    unchanged = belief._replace(bearings=belief.bearings + 1)
    if len(hull) == 0:
        return unchanged
    weight, x0, y0, h = _cropped(belief, hull, COARSE_CELLS if rules.blur > 0.0 else FEWEST_CELLS)
    ny, nx = weight.shape
    rows, columns = np.arange(int(ny)), np.arange(int(nx))
    dy = y0 + (rows + 0.5) * h - place[1]
    low = np.zeros(ny)
    high = np.full(ny, float(nx))
    for normal in (to_left_of_right, to_right_of_left, np.array([np.cos(angle), np.sin(angle)])):
        low, high = _narrowed(low, high, normal, dy, x0 - place[0], h)
    touched = (columns >= low[:, None]) & (columns < high[:, None])
    dx = x0 + (columns + 0.5) * h - place[0]
    weight = np.where(touched, weight, 0.0) * likelihood(rules, dx[None, :], dy[:, None], angle, h)
    if not weight.sum() > 0:
        return unchanged
    return Belief(weight, x0, y0, h, hull, belief.bearings + 1, doubled=max(nx, ny) < COARSE_CELLS)


def _cropped(belief: Belief, hull: FloatArray, fewest: int) -> tuple[FloatArray, float, float, float]:
    """The cells that touch the hull's rectangle, doubled when due or when fewer than `fewest`: weight, x0, y0, h."""
    extent = hull.max(axis=0) - hull.min(axis=0)
    doublings = int(belief.doubled)
    while True:
        h = belief.h / 2.0**doublings
        ny, nx = belief.weight.shape[0] << doublings, belief.weight.shape[1] << doublings
        (x_min, y_min), (x_max, y_max) = hull.min(axis=0), hull.max(axis=0)
        i0, i1 = aligned_range(x_min - belief.x0, x_max - belief.x0, h, nx)
        j0, j1 = aligned_range(y_min - belief.y0, y_max - belief.y0, h, ny)
        enough = max(i1 - i0, j1 - j0) >= fewest or extent.max() <= 0
        if enough or doublings >= DEEPEST_DOUBLING:
            break
        doublings += 1
    rows, columns = np.arange(j0, j1) >> doublings, np.arange(i0, i1) >> doublings
    return belief.weight[np.ix_(rows, columns)], belief.x0 + i0 * h, belief.y0 + j0 * h, h


def _narrowed(
    low: FloatArray, high: FloatArray, normal: FloatArray, dy: FloatArray, left: float, h: float
) -> tuple[FloatArray, FloatArray]:
    """Columns of each row whose centre has normal . (dx, dy) >= -h / sqrt(2), dx = left + (i + 0.5) h."""
    reach = -h / np.sqrt(2.0) - normal[1] * dy
    if normal[0] > NEARLY:
        return np.maximum(low, np.ceil((reach / normal[0] - left) / h - 0.5 - NEARLY)), high
    if normal[0] < -NEARLY:
        return low, np.minimum(high, np.floor((reach / normal[0] - left) / h - 0.5 + NEARLY) + 1.0)
    return low, np.where(reach <= NEARLY * h, high, 0.0)


def likelihood(rules: Rules, dx: FloatArray, dy: FloatArray, angle: float, h: float) -> FloatArray:
    """exp(-e^2 / (2 sigma^2)), e the angle between (dx, dy) and the bearing; with blur as cells of side h can show it.

    Beyond 4 sigma, and for places that are not ahead of the sensor, that of the wedge's edge. What cells show is
    observation.resolved_likelihood: with s = min(1, r^2 / (blur h^2)) and r^2 at least 2 (THINNEST h)^2 it is
    sqrt(s) times the likelihood of s sin^2 e.
    """
    along = np.cos(angle) * dx + np.sin(angle) * dy
    across = np.cos(angle) * dy - np.sin(angle) * dx
    length2 = along**2 + across**2
    sin2 = np.where(along > NEARLY * h, across**2 / np.where(length2 > 0, length2, 1.0), 1.0)
    share = np.ones_like(length2)
    if rules.blur > 0.0:
        distance2 = np.maximum(length2, 2.0 * (THINNEST * h) ** 2)
        share = np.minimum(distance2 / (rules.blur * h * h), 1.0)
    series = np.polynomial.Polynomial(rules.likelihood)
    root = np.asarray(series(np.minimum(sin2 * share, rules.edge)), dtype=np.float64)
    return np.asarray(root**LIKELIHOOD_POWER * np.sqrt(share), dtype=np.float64)


def estimate(belief: Belief, estimator: int, flat: bool, threshold: float) -> PointEstimate:
    """Point estimate, covariance about it (3.34), expected RMSE (3.58).

    GEOMETRIC_MEDIAN: the mean, but the median where that is what brings the expected RMSE below the threshold.
    """
    rows, columns = np.nonzero(belief.weight)
    weight = belief.weight[rows, columns]
    mass = weight / weight.sum()
    x = centres(belief.x0, belief.h, belief.weight.shape[1])[columns]
    y = centres(belief.y0, belief.h, belief.weight.shape[0])[rows]
    px, py = float(mass @ x), float(mass @ y)
    if estimator == MAP and not (flat and belief.bearings <= 1):
        best = int(np.argmax(weight.view(np.int64) >> TIE_BITS))
        px, py = float(x[best]), float(y[best])
    found = _about(mass, x, y, px, py)
    if estimator == GEOMETRIC_MEDIAN and threshold <= found.expected_rmse < MEDIAN_REACH * threshold:
        median = _about(mass, x, y, *_median(mass, x, y, px, py, 1e-3 * belief.h))
        return median if median.expected_rmse < threshold else found
    return found


def _about(mass: FloatArray, x: FloatArray, y: FloatArray, px: float, py: float) -> PointEstimate:
    dx, dy = x - px, y - py
    expected_rmse = float(mass @ np.sqrt(dx**2 + dy**2))
    return PointEstimate(px, py, float(mass @ dx**2), float(mass @ (dx * dy)), float(mass @ dy**2), expected_rmse)


def _median(
    mass: FloatArray, x: FloatArray, y: FloatArray, px: float, py: float, tolerance: float
) -> tuple[float, float]:
    for _ in range(MEDIAN_STEPS):
        pull = mass / np.maximum(np.sqrt((x - px) ** 2 + (y - py) ** 2), tolerance)
        px, py = float(pull @ x / pull.sum()), float(pull @ y / pull.sum())
    return px, py


def confidence_hull(belief: Belief) -> FloatArray:
    """Convex hull of the heaviest cells that hold 95 % of the mass; whole bins of equal weight (1/16 octave) enter."""
    weight = np.ascontiguousarray(belief.weight)
    bins = weight.view(np.int64) >> HISTOGRAM_SHIFT
    below_top = bins.max() - bins
    counted = below_top < HISTOGRAM_BINS
    share = np.asarray(np.bincount(below_top[counted], weights=weight[counted]), dtype=np.float64)
    last = int(np.searchsorted(np.cumsum(share), CONFIDENCE * float(weight.sum()) * (1.0 - NEARLY)))
    return cells_hull(below_top <= last, belief.x0, belief.y0, belief.h)
