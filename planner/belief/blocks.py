"""Places weighed on blocks of cells first, and on smaller blocks only where the belief is not even across them.

A bearing leaves most of the area to the outliers, smooth and nearly empty, and every cell costs the same. Where
neighbouring blocks differ little, or hold next to nothing, their cells get their share by the prior.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from planner.belief.grid import centres
from planner.belief.sharp import Crossings
from planner.types import BoolArray, FloatArray

FEW_CELLS = 3000
"""Grids of fewer are weighed cell by cell."""
FEW_DEAR_CELLS = 700
"""The same where stretches of way make each cell tens of times as dear."""
WIDEST = 4
"""Cells along the side of the largest blocks: at least three lie across the 95 % region of a refined grid."""
EVEN = 3e-3
"""Mass whose place within its blocks may stay open on a level, each block's times how much its surroundings differ. In
missions the density is then off by up to 3e-4 in total variation; more where a ridge is narrower than a cell, of which
cells tell little, either way."""


class Places(NamedTuple):
    """x, y (c,) of the blocks that were not split, m ENU; their mass (c,), which sums to 1; density: (ny, nx) the mass
    of the cells."""

    x: FloatArray
    y: FloatArray
    mass: FloatArray
    density: FloatArray


Weigh = Callable[[FloatArray, FloatArray], FloatArray]
"""x, y (c,) to the logarithm (c,) of the likelihood there."""


def weighed_in_blocks(
    prior: FloatArray,
    x0: float,
    y0: float,
    h: float,
    weigh: Weigh,
    few: int = FEW_CELLS,
    sharp: Crossings | None = None,
) -> Places:
    """prior: (ny, nx) mass of the cells, not all of them 0; x0, y0: south-west corner, m ENU; h: cell size, m. few:
    cells that are not worth blocks. sharp: around these, within the grid, every cell is weighed."""
    side = 1
    while side < WIDEST and prior.size / side**2 > few:
        side *= 2
    ny, nx = prior.shape
    padded = np.pad(prior, ((0, -ny % side), (0, -nx % side)))
    log: FloatArray = np.full((padded.shape[0] // side, padded.shape[1] // side), -np.inf)
    asked: BoolArray = np.ones(log.shape, dtype=bool)
    found: list[tuple[FloatArray, FloatArray, FloatArray, FloatArray]] = []
    while True:
        mass = padded.reshape(log.shape[0], side, log.shape[1], side).sum(axis=(1, 3))
        asked &= mass > 0.0
        rows, columns = np.nonzero(asked)
        x, y = centres(x0, side * h, log.shape[1])[columns], centres(y0, side * h, log.shape[0])[rows]
        log[asked] = weigh(x, y)
        split = _uneven(mass, log, asked) if side > 1 else np.zeros_like(asked)
        if side > 1 and sharp is not None:
            split |= asked & _around_points(log.shape, (sharp.y - y0) / (side * h), (sharp.x - x0) / (side * h))
        left = ~split[asked]
        found.append((x[left], y[left], mass[asked][left], log[asked][left]))
        if side == 1:
            break
        side //= 2
        log, asked = log.repeat(2, axis=0).repeat(2, axis=1), split.repeat(2, axis=0).repeat(2, axis=1)
    x, y, mass, log_of = (np.concatenate(some) for some in zip(*found, strict=True))
    top = log_of.max()
    mass = mass * np.exp(log_of - top)
    density = prior * np.exp(log[:ny, :nx] - top)
    return Places(x, y, mass / mass.sum(), density / density.sum())


def _uneven(mass: FloatArray, log: FloatArray, asked: BoolArray) -> BoolArray:
    """Which of the blocks asked for to split. mass: of the prior; log: likelihood, -inf where there is no mass."""
    known = np.isfinite(log)
    density = mass * np.exp(log - log[known].max())
    most, least = _around(np.where(known, log, -np.inf), np.maximum), _around(np.where(known, log, np.inf), np.minimum)
    near = _around(density / density.sum(), np.maximum)  # a ridge may pass between two blocks' centres
    differs = np.zeros(asked.shape)
    differs[asked] = near[asked] * np.minimum(most[asked] - least[asked], 1.0)
    order = np.argsort(differs, axis=None)
    split = np.zeros(asked.size, dtype=bool)
    split[order[np.cumsum(differs.ravel()[order]) > EVEN]] = True
    return split.reshape(asked.shape) & asked


def _around_points(shape: tuple[int, ...], row: FloatArray, column: FloatArray) -> BoolArray:
    """Which blocks hold one of the points, or are next to one that does."""
    found = np.zeros(shape)
    found[row.astype(int), column.astype(int)] = 1.0
    return _around(found, np.maximum) > 0.0


def _around(level: FloatArray, pick: np.ufunc) -> FloatArray:
    """The most or least of each block and its eight neighbours."""
    padded = np.pad(level, 1, mode="edge")
    rows = pick(pick(padded[:-2], padded[1:-1]), padded[2:])
    return pick(pick(rows[:, :-2], rows[:, 1:-1]), rows[:, 2:])
