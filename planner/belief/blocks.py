"""Places weighed on blocks of cells first, and on smaller blocks only where the belief is not even across them.

A bearing leaves most of the area to the outliers, smooth and nearly empty, and every cell costs the same. Where
neighbouring blocks differ little, or hold next to nothing, their cells get their share by the prior.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from planner.belief.grid import centres
from planner.belief.sharp import Crossings
from planner.belief.within_cells import Parts, in_parts
from planner.types import BoolArray, FloatArray, IntArray

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

NEARLY_THE_SAME = 0.1
"""Total variation, and share of the mean distance: what cells in parts change by less stays as the centres have it."""


class PartsOfCells(NamedTuple):
    """x, y (p,) m ENU. prior: (p,) mass of each. All of a cell that has any."""

    x: FloatArray
    y: FloatArray
    prior: FloatArray


class Places(NamedTuple):
    """x, y (c,) of the blocks that were not split and of cells' parts, m ENU; their mass (c,), which sums to 1.
    density: (ny, nx) the mass of the cells. parts: what cells were weighed in; None: their centres stand for all."""

    x: FloatArray
    y: FloatArray
    mass: FloatArray
    density: FloatArray
    parts: PartsOfCells | None = None


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
    cells that are not worth blocks. sharp: around these, where they are narrower than cells, cells are weighed in
    parts."""
    side = 1
    while side < WIDEST and prior.size / side**2 > few:
        side *= 2
    ny, nx = prior.shape
    padded = np.pad(prior, ((0, -ny % side), (0, -nx % side)))
    log: FloatArray = np.full((padded.shape[0] // side, padded.shape[1] // side), -np.inf)
    asked: BoolArray = np.ones(log.shape, dtype=bool)
    found: list[_Blocks] = []
    while True:
        mass = padded.reshape(log.shape[0], side, log.shape[1], side).sum(axis=(1, 3))
        asked &= mass > 0.0
        rows, columns = np.nonzero(asked)
        x, y = centres(x0, side * h, log.shape[1])[columns], centres(y0, side * h, log.shape[0])[rows]
        log[asked] = weigh(x, y)
        split = _uneven(mass, log, asked) if side > 1 else np.zeros_like(asked)
        left = ~split[asked]
        found.append(_Blocks(side, rows[left], columns[left], x[left], y[left], mass[asked][left], log[asked][left]))
        if side == 1:
            break
        side //= 2
        log, asked = log.repeat(2, axis=0).repeat(2, axis=1), split.repeat(2, axis=0).repeat(2, axis=1)
    log = log[:ny, :nx]
    parts = None if sharp is None else in_parts(prior, log, x0, y0, h, weigh, sharp)
    if parts is not None and (otherwise := _with_parts(prior, log, found, parts)) is not None:
        return otherwise
    x, y, mass, log_of = (np.concatenate(some) for some in zip(*(one[3:] for one in found), strict=True))
    top = log_of.max()
    mass = mass * np.exp(log_of - top)
    density = prior * np.exp(log - top)
    return Places(x, y, mass / mass.sum(), density / density.sum())


class _Blocks(NamedTuple):
    """That were not split, of `side` x `side` cells: rows, columns (c,) among those of their size; x, y (c,) m ENU;
    mass (c,) of the prior; log (c,) of the likelihood."""

    side: int
    rows: IntArray
    columns: IntArray
    x: FloatArray
    y: FloatArray
    mass: FloatArray
    log: FloatArray


def _with_parts(prior: FloatArray, log: FloatArray, found: Sequence[_Blocks], parts: Parts) -> Places | None:
    """The cells in parts have the sum of those, and are no longer in their blocks. None: nothing changes."""
    top = float(np.concatenate([parts.log, *(one.log for one in found)]).max())
    density = prior * np.exp(log - top)
    centres_alone = density / density.sum()
    weight = parts.share * prior[parts.rows, parts.columns][parts.of]
    of_part = weight * np.exp(parts.log - top)
    density[parts.rows, parts.columns] = np.bincount(parts.of, of_part, len(parts.rows))
    density /= density.sum()
    if not _differ(centres_alone, density):
        return None
    masses: list[FloatArray] = []
    for one in found:
        taken = np.zeros((-(-prior.shape[0] // one.side), -(-prior.shape[1] // one.side)))
        np.add.at(taken, (parts.rows // one.side, parts.columns // one.side), prior[parts.rows, parts.columns])
        left = np.maximum(one.mass - taken[one.rows, one.columns], 0.0)
        masses.append(left * np.exp(one.log - top))
    mass = np.concatenate([*masses, of_part])
    x, y = np.concatenate([*(one.x for one in found), parts.x]), np.concatenate([*(one.y for one in found), parts.y])
    return Places(x, y, mass / mass.sum(), density, PartsOfCells(parts.x, parts.y, weight))


def _differ(some: FloatArray, others: FloatArray) -> bool:
    """Whether two densities do, in total variation or in the mean distance from the densest cell."""
    if 0.5 * float(np.abs(some - others).sum()) > NEARLY_THE_SAME:
        return True
    row, column = np.unravel_index(int(np.argmax(others)), others.shape)
    away = np.hypot(*np.ogrid[-row : others.shape[0] - row, -column : others.shape[1] - column])
    mean = float((others * away).sum())
    return abs(float((some * away).sum()) - mean) > NEARLY_THE_SAME * max(mean, 1.0)


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


def _around(level: FloatArray, pick: np.ufunc) -> FloatArray:
    """The most or least of each block and its eight neighbours."""
    padded = np.pad(level, 1, mode="edge")
    rows = pick(pick(padded[:-2], padded[1:-1]), padded[2:])
    return pick(pick(rows[:, :-2], rows[:, 1:-1]), rows[:, 2:])
