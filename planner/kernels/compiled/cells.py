"""Gathering the cells that a bearing leaves alive: the columns of each row that its widened wedge touches.

They go into flat arrays, weights with coordinates along and across the bearing. Doubling the grid costs nothing: the
gather reads each parent twice.
"""

from __future__ import annotations

import numpy as np

from planner.compiling import inlined, jit
from planner.kernels.compiled.lanes import BLOCK, copy_block, copy_doubled_block, store_ramp
from planner.kernels.reference.belief import NEARLY


@inlined
def gather(weight, offset, low, high, x0, y0, h, k, i0, i1, j0, j1, px, py, c, s, rx, ry, lx, ly, work, now):
    """Copy the live cells of rows j0..j1, columns i0..i1 that the widened wedge touches; h and the indices are those of
    the grid doubled k times. Returns how many cells there are.
    """
    target = work.weight[now]
    left, bottom = x0 + i0 * h - px, y0 + (j0 + 0.5) * h - py
    r_way, r_start, r_slope = _crossing(rx, ry, left, bottom, h)
    l_way, l_start, l_slope = _crossing(lx, ly, left, bottom, h)
    c_way, c_start, c_slope = _crossing(c, s, left, bottom, h)
    n = 0
    for j in range(j0, j1):
        row = j >> k
        up = float(j - j0)
        a, b = _narrowed(0, i1 - i0, r_way, r_start + r_slope * up)
        a, b = _narrowed(a, b, l_way, l_start + l_slope * up)
        a, b = _narrowed(a, b, c_way, c_start + c_slope * up)
        first, last, base = low[row], high[row], offset[row] - low[row]
        first, last = max(first, (a + i0) >> k), min(last, ((b + i0 - 1) >> k) + 1)
        a, b = max(a, (first << k) - i0), min(b, (last << k) - i0)
        count = max(b - a, 0)
        work.offset[now, j - j0], work.low[now, j - j0], work.high[now, j - j0] = n, a, a + count
        if count == 0:
            continue
        dx, dy = left + (a + 0.5) * h, bottom + up * h
        _place_cells(work.along, work.across, n, count, c * dx + s * dy, c * dy - s * dx, c * h, -s * h)
        _copy_cells(weight, target, base, a + i0, n, count, k)
        n += count
    return n


@jit
def _place_cells(along, across, n, count, a0, b0, step_a, step_b):
    """Coordinates of `count` cells of one row, in whole blocks."""
    for first in range(0, count, BLOCK):
        store_ramp(along, n + first, a0 + step_a * first, step_a)
        store_ramp(across, n + first, b0 + step_b * first, step_b)


@jit
def _copy_cells(weight, target, base, column, n, count, k):
    """Weights of `count` cells of one row from `column` of the grid doubled k times, in whole blocks where it pays."""
    if k == 0:
        for first in range(0, count, BLOCK):
            copy_block(target, n + first, weight, base + column + first)
    elif k == 1:
        odd = column & 1
        target[n] = weight[base + (column >> 1)]
        for first in range(odd, count, BLOCK):
            copy_doubled_block(target, n + first, weight, base + ((column + first) >> 1))
    else:
        for i in range(count):
            target[n + i] = weight[base + ((column + i) >> k)]


@jit
def _crossing(nx, ny, left, bottom, h):
    """Where a side of the widened wedge, nx dx + ny dy >= -h / sqrt(2), crosses the rows of cell centres.

    Returns the way it opens (1 east, -1 west, 0 along the rows) and the column of row 0 and its slope; for a side along
    the rows what is left of the margin, in cells.
    """
    reach = -h / np.sqrt(2.0) - ny * bottom
    if abs(nx) <= NEARLY:
        return 0, NEARLY - reach / h, ny
    return 1 if nx > 0.0 else -1, (reach / nx - left) / h - 0.5, -ny / nx


@jit
def _narrowed(a, b, way, column):
    """The columns of a..b on the inner side of a wedge's side that crosses the row at `column`."""
    if way > 0:
        edge = np.ceil(column - NEARLY)
        return (max(a, int(edge)), b) if edge < b else (b, b)
    if way < 0:
        edge = np.floor(column + NEARLY) + 1.0
        return (a, min(b, int(edge))) if edge > a else (a, a)
    return (a, b) if column >= 0.0 else (a, a)


@inlined
def gather_all(weight, offset, low, high, x0, y0, h, ny, px, py, c, s, work, now):
    """All live cells as they are, in the frame of a bearing that changed nothing. Returns how many."""
    target, along, across = work.weight[now], work.along, work.across
    n = 0
    for j in range(ny):
        dy = y0 + (j + 0.5) * h - py
        work.offset[now, j], work.low[now, j], work.high[now, j] = n, low[j], high[j]
        for i in range(low[j], high[j]):
            dx = x0 + (i + 0.5) * h - px
            along[n], across[n] = c * dx + s * dy, c * dy - s * dx
            target[n] = weight[offset[j] + i - low[j]]
            n += 1
    return n
