"""The bearing sensor as the filter assumes it: likelihoods, hard wedges, simulated bearings.

z = atan2(y_t - y_s, x_t - x_s) + w, w ~ N(0, sigma^2) (4.2). Angles: rad ccw from east.
"""

from __future__ import annotations

import numpy as np

from planner.reasons import UnusableBearing
from planner.types import Bearing, BoolArray, FloatArray, PlannerError

WEDGE_SIGMAS = 4.0
"""A target lies within this many sigma of an honest bearing (spec 2)."""

THINNEST = 0.5
"""Standard deviation, in cells, of the thinnest Gaussian whose values at cell centres stand for it: its mass to
2 exp(-2 pi^2 THINNEST^2) = 1.4 % (Poisson's sum), its variance to 15 %, more or less by where it lies between them."""

FEWEST_DIRECTIONS = 8
"""Of a bearing's profile; a direction finder's has 360."""

WIDEST_HARD_WEDGE = np.deg2rad(80.0)
"""Half angles above this are no usable wedge: the bearing only weighs, it does not cut."""


def wrap(angle: FloatArray | float) -> FloatArray:
    """Angle in [-pi, pi)."""
    return (np.asarray(angle) + np.pi) % (2 * np.pi) - np.pi


def expected_bearing(x: float, y: float, target_x: FloatArray | float, target_y: FloatArray | float) -> FloatArray:
    """Direction from the sensor (x, y) to the target."""
    return np.arctan2(np.asarray(target_y) - y, np.asarray(target_x) - x)


def cuts(bearing: Bearing) -> bool:
    """Whether the bearing has a hard +-4 sigma wedge: no outlier mixture, no second peak, and narrow enough."""
    honest = bearing.outlier_probability == 0.0 and not bearing.peaks
    return honest and WEDGE_SIGMAS * bearing.sigma <= WIDEST_HARD_WEDGE


def gaussian_likelihood(error: FloatArray, sigma: float) -> FloatArray:
    """exp(-e^2 / (2 sigma^2)) of the wrapped error, 1 at its peak."""
    return np.exp(-0.5 * (wrap(error) / sigma) ** 2)


def hard_likelihood(bearing: Bearing, x: FloatArray, y: FloatArray, margin: float) -> FloatArray:
    """Likelihood at cell centres (x, y), zero outside the +-4 sigma wedge widened by `margin` m.

    A cell that the wedge touches although its centre lies outside keeps the likelihood of the wedge's edge, as does the
    one in whose centre the sensor stands.
    """
    half = WEDGE_SIGMAS * bearing.sigma
    error = np.minimum(np.abs(wrap(expected_bearing(bearing.x, bearing.y, x, y) - bearing.angle)), half)
    error = np.where((x == bearing.x) & (y == bearing.y), half, error)
    return np.where(inside_wedge(bearing, x, y, margin), gaussian_likelihood(error, bearing.sigma), 0.0)


def resolved_likelihood(bearing: Bearing, x: FloatArray, y: FloatArray, h: float) -> FloatArray:
    """Likelihood at the centres (x, y) of cells of side h (m) of a wedge no narrower than they can show.

        sigma / sqrt(v) exp(-e^2 / (2 v)),   v = max(sigma^2, (THINNEST h / r)^2)

    with e the error at the centre and r the distance, of the nearest cells at least sqrt(2) THINNEST h (then v is half
    a square radian): a wedge that is wider is taken as it is, a narrower one keeps its mass and is widened. Zero for
    cells that the wedge misses; no cell that it touches has less than exp(-8) for its exponential, as at the edge.
    """
    error = wrap(expected_bearing(bearing.x, bearing.y, x, y) - bearing.angle)
    thinnest2 = (THINNEST * h) ** 2
    variance = np.maximum(
        bearing.sigma**2, thinnest2 / np.maximum((x - bearing.x) ** 2 + (y - bearing.y) ** 2, 2.0 * thinnest2)
    )
    exponent = np.minimum(0.5 * error**2 / variance, 0.5 * WEDGE_SIGMAS**2)
    weight = bearing.sigma / np.sqrt(variance) * np.exp(-exponent)
    return np.where(inside_wedge(bearing, x, y, h / np.sqrt(2.0)), weight, 0.0)


def inside_wedge(bearing: Bearing, x: FloatArray, y: FloatArray, margin: float) -> BoolArray:
    """Whether points lie in the +-4 sigma wedge widened by `margin` m to each side and behind its apex."""
    half = WEDGE_SIGMAS * bearing.sigma
    dx, dy = x - bearing.x, y - bearing.y
    right, left = bearing.angle - half, bearing.angle + half
    return (
        (np.cos(right) * dy - np.sin(right) * dx >= -margin)
        & (np.sin(left) * dx - np.cos(left) * dy >= -margin)
        & (np.cos(bearing.angle) * dx + np.sin(bearing.angle) * dy >= -margin)
    )


def mixture_likelihood(bearing: Bearing, x: FloatArray, y: FloatArray) -> FloatArray:
    """(1 - eps) sum_i w_i N(z; angle_i, sigma) + eps / (2 pi), the weights w_i normalized, per rad."""
    angles = np.array([bearing.angle, *(peak.angle for peak in bearing.peaks)])
    weights = np.array([1.0, *(peak.weight for peak in bearing.peaks)])
    direction = expected_bearing(bearing.x, bearing.y, x, y)
    density = sum(
        w * gaussian_likelihood(direction - a, bearing.sigma)
        for a, w in zip(angles, weights / weights.sum(), strict=True)
    ) / (bearing.sigma * np.sqrt(2 * np.pi))
    return (1.0 - bearing.outlier_probability) * density + bearing.outlier_probability / (2 * np.pi)


def validate_bearing(bearing: Bearing) -> None:
    """PlannerError when a number is not usable."""
    if not np.isfinite([bearing.x, bearing.y, bearing.angle, bearing.sigma]).all():
        raise PlannerError(UnusableBearing("not_finite"))
    if bearing.sigma <= 0:
        raise PlannerError(UnusableBearing("sigma"))
    if not 0.0 <= bearing.outlier_probability < 1.0:
        raise PlannerError(UnusableBearing("outlier_probability"))
    if any(not np.isfinite([peak.angle, peak.weight]).all() or peak.weight <= 0 for peak in bearing.peaks):
        raise PlannerError(UnusableBearing("peak"))
    if bearing.profile and (len(bearing.profile) < FEWEST_DIRECTIONS or not np.isfinite(bearing.profile).all()):
        raise PlannerError(UnusableBearing("profile"))
