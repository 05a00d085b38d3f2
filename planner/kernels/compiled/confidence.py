"""The hull of the 95 % cells, and distances to it."""

from __future__ import annotations

import numpy as np

from planner.compiling import inlined, jit
from planner.kernels.compiled.lanes import bits
from planner.kernels.reference.belief import CONFIDENCE, HISTOGRAM_BINS, HISTOGRAM_SHIFT, NEARLY


@inlined
def confidence_hull(work, now, cells, heaviest, m0, x0, y0, h, ny):
    """Hull of the 95 % cells in work.chain, counter-clockwise (see reference.belief); returns its corners."""
    weight, histogram, chain = work.weight[now], work.histogram, work.chain
    top = bits(weight[heaviest]) >> HISTOGRAM_SHIFT
    for i in range(HISTOGRAM_BINS):
        histogram[i] = 0.0
    for i in range(cells):
        below = top - (bits(weight[i]) >> HISTOGRAM_SHIFT)
        if below < HISTOGRAM_BINS:
            histogram[below] += weight[i]
    wanted, held, last = CONFIDENCE * m0 * (1.0 - NEARLY), 0.0, -1
    while held < wanted and last + 1 < HISTOGRAM_BINS:
        last += 1
        held += histogram[last]
    m = 0
    for j in range(ny):
        past = _heavy_from_right(weight, work.offset[now, j], work.high[now, j] - work.low[now, j], top, last)
        if past > 0:
            x = x0 + (work.low[now, j] + past) * h
            m = _pushed(chain, m, 0, x, y0 + j * h)
            m = _pushed(chain, m, 0, x, y0 + (j + 1) * h)
    base = m
    for j in range(ny - 1, -1, -1):
        first = _heavy_from_left(weight, work.offset[now, j], work.high[now, j] - work.low[now, j], top, last)
        if first >= 0:
            x = x0 + (work.low[now, j] + first) * h
            m = _pushed(chain, m, base, x, y0 + (j + 1) * h)
            m = _pushed(chain, m, base, x, y0 + j * h)
    return m


@jit
def _heavy_from_right(weight, offset, count, top, last):
    for i in range(count, 0, -1):
        if top - (bits(weight[offset + i - 1]) >> HISTOGRAM_SHIFT) <= last:
            return i
    return 0


@jit
def _heavy_from_left(weight, offset, count, top, last):
    for i in range(count):
        if top - (bits(weight[offset + i]) >> HISTOGRAM_SHIFT) <= last:
            return i
    return -1


@jit
def _pushed(chain, m, base, x, y):
    """Add a corner to a chain that turns left, dropping those that no longer stick out; returns the new length."""
    while m - base >= 2:
        ax, ay, bx, by = chain[m - 2, 0], chain[m - 2, 1], chain[m - 1, 0], chain[m - 1, 1]
        if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0:
            break
        m -= 1
    chain[m, 0], chain[m, 1] = x, y
    return m + 1


@jit
def clear(hull, corners, x, y, needed, at_most):
    """Whether (x, y) is at least `needed` m away from the hull, of which a point is at most `at_most` m away."""
    if at_most < needed:
        return False
    for v in range(corners):
        dx, dy = hull[v, 0] - x, hull[v, 1] - y
        if dx * dx + dy * dy < needed * needed and needed > 0.0:
            return False
    return distance_to_hull(hull, corners, x, y) >= needed


@jit
def distance_to_hull(hull, corners, x, y):
    """m from (x, y) to a counter-clockwise convex polygon, 0 inside."""
    inside, nearest = True, np.inf
    ax, ay = hull[corners - 1, 0], hull[corners - 1, 1]
    for v in range(corners):
        bx, by = hull[v, 0], hull[v, 1]
        ux, uy, vx, vy = bx - ax, by - ay, x - ax, y - ay
        inside = inside and ux * vy - uy * vx >= 0.0
        part = min(max((ux * vx + uy * vy) / max(ux * ux + uy * uy, 1e-300), 0.0), 1.0)
        dx, dy = vx - part * ux, vy - part * uy
        nearest = min(nearest, dx * dx + dy * dy)
        ax, ay = bx, by
    return 0.0 if inside else np.sqrt(nearest)
