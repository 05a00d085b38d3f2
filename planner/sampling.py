"""Sample paths for rollouts: a target drawn from the belief and the errors of all bearings to come (spec 4).

`deterministic`: the density split recursively into equal masses, zero noise (Klumpp and Hanebeck 2008). `crn`: common
random numbers, the j-th path is the same for every action. `pmc`: independent paths. Chance comes from the generator
that is given, there is no other.
"""

from __future__ import annotations

import numpy as np

from planner.belief.grid import GridBelief
from planner.kernels.model import Paths
from planner.reasons import UnusableNumber
from planner.types import FloatArray, PlannerError

LARGEST_NOISE = 3.0
"""Noise beyond this many sigma is drawn again (spec 8)."""


def random_paths(belief: GridBelief, sigma: float, count: int, bearings: int, rng: np.random.Generator) -> Paths:
    """`count` paths of `bearings` bearings each: a cell drawn by mass, a uniform place inside it, Gaussian noise."""
    targets = random_targets(belief, count, rng)
    return Paths(targets, random_noise(sigma, (count, bearings), rng))


def random_targets(belief: GridBelief, count: int, rng: np.random.Generator) -> FloatArray:
    """(count, 2) m: a cell drawn by its mass, then a uniform place inside it."""
    cumulative: FloatArray = np.cumsum(belief.density.ravel())
    cells = np.searchsorted(cumulative, rng.random(count) * float(cumulative[-1]), side="right")
    cells = np.minimum(cells, int(np.flatnonzero(belief.density.ravel())[-1]))
    corners = np.column_stack([cells % belief.nx, cells // belief.nx])
    return np.array([belief.x0, belief.y0]) + (corners + rng.random((count, 2))) * belief.h


def random_noise(sigma: float, shape: tuple[int, ...], rng: np.random.Generator) -> FloatArray:
    """N(0, sigma^2) in rad, redrawn beyond 3 sigma."""
    noise = rng.standard_normal(shape)
    while (beyond := np.abs(noise) > LARGEST_NOISE).any():
        noise[beyond] = rng.standard_normal(int(beyond.sum()))
    return sigma * noise


def deterministic_paths(belief: GridBelief, count: int, bearings: int) -> Paths:
    """`count` = 2^m noiseless paths whose targets stand for equal shares of the mass."""
    if count < 1 or count & (count - 1):
        raise PlannerError(UnusableNumber("paths", "power_of_two", str(count)))
    return Paths(equal_mass_points(belief, count), np.zeros((count, bearings)))


def equal_mass_points(belief: GridBelief, count: int) -> FloatArray:
    """(count, 2) m: the mean of each part when the density is halved by mass along x, y, x, ... until count parts.

    A column (row) in which the half falls is shared between both parts.
    """
    x, y = belief.centres()
    return np.array(_split(belief.density, x, y, count, axis=1))


def _split(density: FloatArray, x: FloatArray, y: FloatArray, count: int, axis: int) -> list[tuple[float, float]]:
    if count == 1:
        mass = density.sum()
        return [(float(density.sum(axis=0) @ x / mass), float(density.sum(axis=1) @ y / mass))]
    cumulative: FloatArray = np.cumsum(density.sum(axis=1 - axis))
    half = 0.5 * float(cumulative[-1])
    cut = int(np.searchsorted(cumulative, half))
    before = cumulative[cut - 1] if cut else 0.0
    share = (half - before) / (cumulative[cut] - before)
    lower = np.ones(len(cumulative))
    lower[cut + 1 :] = 0.0
    lower[cut] = share
    weights = lower if axis == 1 else lower[:, None]
    parts = (density * weights, density * (1.0 - weights))
    return [point for part in parts for point in _split(part, x, y, count // 2, 1 - axis)]
