"""Mass within cells: where bearings cross more narrowly than a cell is wide, its centre does not stand for it.

Around each such crossing that holds mass a cell is weighed in four parts, each of those around the crossing in four
again, until they are narrower than what the bearings leave. A cell has the sum of its parts.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from planner.belief.sharp import CELLS_A_WIDTH, Crossings
from planner.geometry import centres
from planner.types import FloatArray, IntArray

TELLING_SHARE = 0.01
"""Of all mass: where no crossing may hold as much, the cells' centres stand for all of it."""
LEAST_SHARE = 1e-4
"""Of all mass: around a crossing that holds less, no cell is weighed in parts."""
NARROWEST_M = 0.05
"""No narrower parts are of use: nobody knows better where a bearing was taken."""
AROUND = np.array([(row, column) for row in (-1, 0, 1) for column in (-1, 0, 1)])
PARTS = np.array([(row, column) for row in (0, 1) for column in (0, 1)])


class Parts(NamedTuple):
    """rows, columns (s,) of the cells that were weighed in parts. of: (p,) which of them a part lies in. x, y (p,) of
    the parts' centres, m ENU; share: (p,) of their cell; log: (p,) of the likelihood there."""

    rows: IntArray
    columns: IntArray
    of: IntArray
    x: FloatArray
    y: FloatArray
    share: FloatArray
    log: FloatArray


def in_parts(
    prior: FloatArray,
    log: FloatArray,
    x0: float,
    y0: float,
    h: float,
    weigh: Callable[[FloatArray, FloatArray], FloatArray],
    sharp: Crossings,
) -> Parts | None:
    """Of the cells (ny, nx) that bearings cross within; None where that tells nothing. log: of the likelihood at their
    centres; the rest as for `planner.belief.blocks.weighed_in_blocks`."""
    ny, nx = prior.shape
    near = sharp.within(x0, y0, x0 + nx * h, y0 + ny * h)
    near = near.only(near.width < CELLS_A_WIDTH * h)
    row, column = _cells_of(near, x0, y0, h, prior.shape)
    possible = prior[row, column] > 0.0
    near, row, column = near.only(possible), row[possible], column[possible]
    if len(row) == 0:
        return None
    width = np.maximum(near.width, NARROWEST_M)
    at_it = weigh(near.x, near.y) + np.log(2.0 * math.pi * (width / h) ** 2 * prior[row, column])
    elsewhere = np.where(prior > 0.0, log, -np.inf)
    around = _around(row, column, prior.shape)
    elsewhere[around // nx, around % nx] = -np.inf
    top = max(float(at_it.max()), float(elsewhere.max()))
    held = np.exp(at_it - top)
    whole = float((prior * np.exp(elsewhere - top)).sum()) + float(held.max())
    if held.max() < TELLING_SHARE * whole:
        return None
    telling = held >= LEAST_SHARE * whole
    return _parted(near.only(telling), width[telling] / math.sqrt(sharp.bearings), prior, x0, y0, h, weigh)


def _parted(
    near: Crossings,
    narrow: FloatArray,
    prior: FloatArray,
    x0: float,
    y0: float,
    h: float,
    weigh: Callable[[FloatArray, FloatArray], FloatArray],
) -> Parts:
    """narrow: (m,) m, what the bearings leave of each crossing."""
    ny, nx = prior.shape
    cells = _around(*_cells_of(near, x0, y0, h, prior.shape), prior.shape)
    cells = cells[prior.ravel()[cells] > 0.0]
    split, side, level = cells, h, 0
    leaves: list[tuple[FloatArray, FloatArray, FloatArray, IntArray]] = []
    while len(split):
        side, level = 0.5 * side, level + 1
        shape = (ny << level, nx << level)
        parent = np.stack(np.divmod(split, shape[1] // 2), axis=1)
        row, column = (2 * parent[:, None, :] + PARTS).reshape(-1, 2).T
        parts = row * shape[1] + column
        within = near.only(narrow < CELLS_A_WIDTH * side)
        again = _around(*_cells_of(within, x0, y0, side, shape), shape)
        left = ~np.isin(parts, again)
        split = parts[~left]
        row, column = row[left], column[left]
        x, y = centres(x0, side, shape[1])[column], centres(y0, side, shape[0])[row]
        leaves.append((x, y, np.full(len(x), 0.25**level), (row >> level) * nx + (column >> level)))
    x, y, share, cell = (np.concatenate(some) for some in zip(*leaves, strict=True))
    return Parts(cells // nx, cells % nx, np.searchsorted(cells, cell), x, y, share, weigh(x, y))


def _cells_of(near: Crossings, x0: float, y0: float, side: float, shape: tuple[int, int]) -> tuple[IntArray, IntArray]:
    """Rows and columns (m,) of the cells that hold them. One at the grid's far edge may round to beyond it."""
    row, column = ((near.y - y0) / side).astype(int), ((near.x - x0) / side).astype(int)
    return np.minimum(row, shape[0] - 1), np.minimum(column, shape[1] - 1)


def _around(row: IntArray, column: IntArray, shape: tuple[int, int]) -> IntArray:
    """The cells that hold one of the points, or are next to one that does: row * columns + column, ascending."""
    found = np.unique((np.stack([row, column], axis=1)[:, None, :] + AROUND).reshape(-1, 2), axis=0)
    kept = ((found >= 0) & (found < shape)).all(axis=1)
    return found[kept, 0] * shape[1] + found[kept, 1]
