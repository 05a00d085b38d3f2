"""What a rollout kernel is given: flat tuples of numbers and arrays, the same for the reference and the compiled one.

Frame: local ENU metres; angles rad ccw from east; times s.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from planner.observation import WEDGE_SIGMAS
from planner.types import FloatArray, IntArray

MAP, EXPECTED_VALUE, GEOMETRIC_MEDIAN = 0, 1, 2
ELLIPSE, FISHER, DYNAMIC_PROGRAM = 0, 1, 2
LINEAR, FULL = 0, 1

LIKELIHOOD_DEGREE = 5
LIKELIHOOD_POWER = 8
WIDEST_SIGMA = np.deg2rad(15.0)
"""Rollouts assume at most this noise: the likelihood's polynomial is good to 3e-4 there, to 1e-5 below 12 deg."""

CLOSED_FEATURES = 10
"""A rollout's end: platform x, y, estimate x, y, covariance xx, xy, yy, expected RMSE, bearings, localized (0 or 1).

Of a localized rollout the expected RMSE is not worked out: the threshold stands there."""


class Start(NamedTuple):
    """The belief a rollout begins with.

    density: (ny, nx) mass a cell. low, high: (ny,) first and past-last live column of each row. x0, y0: south-west
    corner, m. h: cell size, m. hull: (m, 2) convex, counter-clockwise. bearings: already folded in. flat: prior known
    as an area only (the expected value is used until the second bearing).
    """

    density: FloatArray
    low: IntArray
    high: IntArray
    x0: float
    y0: float
    h: float
    hull: FloatArray
    bearings: int
    flat: bool


class Rules(NamedTuple):
    """The problem as numbers.

    likelihood: (6,) coefficients of p in L = p(sin^2 e)^8, lowest first. edge: sin^2 of 4 sigma. blur: (THINNEST /
    sigma)^2 for wedges no narrower than cells can show, 0 for cell centres. threshold: m.
    motion: LINEAR or FULL. standoff: m, of a Fisher action to C95. places: (l, 2) m, the fixed lattice; with none the
    grid_x x grid_y cells of the tripled belief rectangle are used, cut with window (x_min, y_min, x_max, y_max).
    travel: (l, l) m between places, or (0, 0) for straight lines. ratios, distances: (n,) the ellipse policy's table.
    horizon: bearings after which a rollout is cut. after, nodes: the dynamic program's table
    (planner.kernels.value), which also closes the rollouts that are cut; empty for other policies.
    """

    sigma: float
    likelihood: FloatArray
    edge: float
    blur: float
    threshold: float
    measurement_time: float
    motion: int
    speed: float
    constant: float
    turn_rate: float
    acceleration: float
    estimator: int
    policy: int
    standoff: float
    places: FloatArray
    travel: FloatArray
    grid_x: int
    grid_y: int
    window: FloatArray
    ratios: FloatArray
    distances: FloatArray
    horizon: int
    after: FloatArray
    nodes: FloatArray


class Actions(NamedTuple):
    """First actions. places: (a, 2) m. costs: (a,) s, flight and measurement. headings: (a,) rad on arrival.

    lattice: (a,) index in Rules.places, -1 where it is none of them.
    """

    places: FloatArray
    costs: FloatArray
    headings: FloatArray
    lattice: IntArray


class Paths(NamedTuple):
    """Sample paths. targets: (p, 2) m. noise: (p, n) rad, n >= horizon bearings' errors, at most 3 sigma."""

    targets: FloatArray
    noise: FloatArray


class Tasks(NamedTuple):
    """Which rollouts to run. action, path: (t,) indices."""

    action: IntArray
    path: IntArray

    def part(self, where: slice) -> Tasks:
        """Views of some of the tasks."""
        return Tasks(self.action[where], self.path[where])


class Outcomes(NamedTuple):
    """Where results go. costs: (t,) s. bearings: (t,) taken in the rollout. ends: (t, 10) see CLOSED_FEATURES."""

    costs: FloatArray
    bearings: IntArray
    ends: FloatArray

    def part(self, where: slice) -> Outcomes:
        """Views of where the results of some of the tasks go."""
        return Outcomes(self.costs[where], self.bearings[where], self.ends[where])


def outcomes(tasks: int) -> Outcomes:
    """Zeros for the results of this many rollouts."""
    return Outcomes(np.zeros(tasks), np.zeros(tasks, dtype=np.int64), np.zeros((tasks, CLOSED_FEATURES)))


def likelihood_polynomial(sigma: float) -> tuple[FloatArray, float]:
    """Coefficients (6,) of p with exp(-e^2 / (2 sigma^2)) = p(sin^2 e)^8 for |e| <= 4 sigma, and sin^2 of 4 sigma.

    The eighth root is nearly straight, so that a low degree fits it; three squarings bring the likelihood back.
    """
    edge = float(np.sin(WEDGE_SIGMAS * sigma) ** 2)
    error = np.arcsin(np.sqrt(0.5 * (_FIT_AT + 1.0) * edge))
    in_nodes = _FIT @ np.exp(-(error**2) / (2.0 * LIKELIHOOD_POWER * sigma**2))
    return in_nodes * (2.0 / edge) ** np.arange(LIKELIHOOD_DEGREE + 1), edge


def _fit(nodes: FloatArray) -> FloatArray:
    """(6, n) from values at n Chebyshev nodes to the coefficients in nodes + 1 of their least squares polynomial: the
    Chebyshev polynomials are orthogonal there, and a plan for many emitters fits one for each."""
    degrees = np.arange(LIKELIHOOD_DEGREE + 1)
    projected = chebyshev.chebvander(nodes, LIKELIHOOD_DEGREE).T * np.where(degrees > 0, 2.0, 1.0)[:, None] / len(nodes)
    powers = np.array([np.resize([*chebyshev.cheb2poly(row), *np.zeros(6)], 6) for row in np.eye(6)]).T
    moved = np.array([[math.comb(j, k) * (-1.0) ** (j - k) if j >= k else 0.0 for j in degrees] for k in degrees])
    return moved @ powers @ projected


_FIT_AT = np.cos(np.pi * (np.arange(64) + 0.5) / 64)
_FIT = _fit(_FIT_AT)
