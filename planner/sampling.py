"""Sample paths for rollouts: a target drawn from the belief and the errors of all bearings to come (spec 4).

`deterministic`: the density split recursively into equal masses, zero noise (Klumpp and Hanebeck 2008). `crn`: common
random numbers, the j-th path is the same for every action. `pmc`: independent paths. Chance comes from the generator
that is given, there is no other. `quasi_random`: common as `crn`, from a shifted Sobol sequence: its points lie
more evenly than chance would have them, over the target's place and the first two bearings' noise.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from planner.belief.grid import GridBelief
from planner.kernels.model import Paths
from planner.reasons import UnusableNumber
from planner.types import FloatArray, IntArray, PlannerError

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


QUASI_DIMENSIONS = 4
"""Target (2) and the noise of the first bearings; later ones are plain random."""

_DIRECTIONS = ((0, 0, ()), (1, 0, (1,)), (2, 1, (1, 3)), (3, 1, (1, 3, 1)))
"""Degree s, polynomial a and m_1..m_s of the first dimensions (Joe and Kuo 2008); the first is van der Corput's."""
_BITS = 30


def quasi_random_paths(
    belief: GridBelief, sigma: float, first: int, count: int, bearings: int, shift: FloatArray, rng: np.random.Generator
) -> Paths:
    """The paths first <= j < first + count of the sequence moved by `shift` (QUASI_DIMENSIONS,), in [0, 1)."""
    points = (sobol(first, count, QUASI_DIMENSIONS) + shift) % 1.0
    noise = random_noise(sigma, (count, bearings), rng)
    own = min(bearings, QUASI_DIMENSIONS - 2)
    noise[:, :own] = sigma * normal_quantile(points[:, 2 : 2 + own], cut=LARGEST_NOISE)
    return Paths(targets_at(belief, points[:, :2]), noise)


def targets_at(belief: GridBelief, points: FloatArray) -> FloatArray:
    """(n, 2) m of points (n, 2) of the unit square: x by the mass of the columns, then y by that of the column's cells.

    Areas go over into equal masses (Rosenblatt 1952); inside a cell the mass is even.
    """
    rows: FloatArray = np.cumsum(belief.density, axis=0)
    columns: FloatArray = np.cumsum(rows[-1])
    i, x = _inverted(columns / columns[-1], points[:, 0])
    share = rows / np.where(rows[-1] > 0, rows[-1], 1.0)
    one_after_another = (share + np.arange(belief.nx)).T.ravel()  # column k rises from k to k + 1
    # a column without mass ends a whole below the next
    j, y = _inverted(one_after_another, i + points[:, 1], i.astype(np.float64))
    return np.array([belief.x0, belief.y0]) + belief.h * np.column_stack([i + x, j - i * belief.ny + y])


def _inverted(cumulative: FloatArray, at: FloatArray, least: FloatArray | float = 0.0) -> tuple[IntArray, FloatArray]:
    """Index of the cell in which `at` falls, and how far into it; no cell begins below `least`."""
    last = int(np.searchsorted(cumulative, float(cumulative[-1])))
    k = np.minimum(np.searchsorted(cumulative, at, side="right"), last)
    before = np.maximum(np.where(k > 0, cumulative[np.maximum(k - 1, 0)], 0.0), least)
    return k.astype(np.int64), np.clip((at - before) / (cumulative[k] - before), 0.0, 1.0)


@lru_cache(256)
def sobol(first: int, count: int, dimensions: int) -> FloatArray:
    """(count, dimensions) points of the Sobol sequence from the number `first` on, in [0, 1); not to be written to."""
    index = np.arange(first, first + count)
    gray = index ^ (index >> 1)
    points = np.zeros((count, dimensions), dtype=np.int64)
    for d in range(dimensions):
        for bit, direction in enumerate(_direction_numbers(d)):
            points[:, d] ^= np.where((gray >> bit) & 1, direction, 0)
    answer = points / float(1 << _BITS)
    answer.setflags(write=False)
    return answer


def _direction_numbers(dimension: int) -> list[int]:
    s, a, m = _DIRECTIONS[dimension]
    if s == 0:
        return [1 << (_BITS - 1 - k) for k in range(_BITS)]
    v = [m[k] << (_BITS - 1 - k) for k in range(s)]
    for k in range(s, _BITS):
        following = v[k - s] ^ (v[k - s] >> s)
        for j in range(1, s):
            following ^= ((a >> (s - 1 - j)) & 1) * v[k - j]
        v.append(following)
    return v


_GRID = np.linspace(-6.0, 6.0, 4801)
_GRID_MASS = np.array([0.5 * math.erfc(-z / math.sqrt(2.0)) for z in _GRID])


def normal_quantile(share: FloatArray, cut: float = 6.0) -> FloatArray:
    """The standard normal number below which lies `share` of the mass within +-cut; by interpolation, to 1e-5."""
    low, high = (0.5 * math.erfc(-z / math.sqrt(2.0)) for z in (-cut, cut))
    return np.interp(low + share * (high - low), _GRID_MASS, _GRID)


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
