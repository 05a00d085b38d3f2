"""A belief on fewer and larger cells: for rollouts, which refine their grids again where a bearing has cut them."""

from __future__ import annotations

import math

import numpy as np

from planner.belief.grid import GridBelief


def coarser(belief: GridBelief, most_cells: int) -> GridBelief:
    """The same mass on square blocks of cells, at most `most_cells` (1 or more) along the longer axis.

    Every block has the sum of its cells, so that no mass moves by more than half a block each way. The belief itself
    when it has few enough cells.
    """
    k = math.ceil(max(belief.nx, belief.ny) / most_cells)
    if k == 1:
        return belief
    columns, rows = math.ceil(belief.nx / k), math.ceil(belief.ny / k)
    padded = np.zeros((rows * k, columns * k))
    padded[: belief.ny, : belief.nx] = belief.density
    return GridBelief(
        density=padded.reshape(rows, k, columns, k).sum(axis=(1, 3)),
        x0=belief.x0,
        y0=belief.y0,
        h=belief.h * k,
        area=belief.area,
        possible=belief.possible,
        bearings=belief.bearings,
        flat_prior=belief.flat_prior,
    )
