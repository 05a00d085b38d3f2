"""Which straight flights meet which borders: every pair of places against every edge, compiled.

A detailed coast line has a thousand corners, so a visibility graph would ask a thousand million times. It asks by
blocks of neighbouring edges, which most flights pass at a distance.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from planner.compiling import exact, exact_entry
from planner.geometry import edges
from planner.types import FloatArray, IntArray, Region

FREE, TOUCHES, CROSSES = 0, 1, 2

BLOCK = 8
"""Edges that are passed over together where a flight does not come near their bounding box."""


def meetings(starts: FloatArray, ends: FloatArray, region: Region) -> NDArray[np.int8]:
    """(n, m) int8 for the segments from (n, 2) `starts` to (m, 2) `ends`, m ENU.

    CROSSES: properly through an edge of the region. TOUCHES: has a point in common with one (a corner, a piece of it)
    but crosses none. FREE: neither.
    """
    met = np.zeros((len(starts), len(ends)), dtype=np.int8)
    a, b = edges(region)
    if met.size and len(a):
        order = _side_by_side(0.5 * (a + b))
        a, b = np.ascontiguousarray(a[order]), np.ascontiguousarray(b[order])
        contiguous = np.ascontiguousarray
        _meetings(contiguous(starts, float), contiguous(ends, float), a, b, _boxes(a, b), met)
    return met


def _side_by_side(places: FloatArray) -> IntArray:
    """(n,) the order that makes blocks of neighbours: strips from west to east, in each from south to north.

    Source: Leutenegger, Edgington and Lopez, STR: a simple and efficient algorithm for R-tree packing, 1997.
    """
    strips = math.ceil(math.sqrt(len(places) / BLOCK))
    place_in_row = np.argsort(np.argsort(places[:, 0]))
    return np.lexsort((places[:, 1], place_in_row * strips // len(places)))


def _boxes(a: FloatArray, b: FloatArray) -> FloatArray:
    """(blocks, 4) m: west, south, east and north of each block of edges from (n, 2) a to b."""
    firsts = np.arange(0, len(a), BLOCK)
    low = np.minimum.reduceat(np.minimum(a, b), firsts)
    return np.column_stack([low, np.maximum.reduceat(np.maximum(a, b), firsts)])


@exact
def _side(ox: float, oy: float, px: float, py: float, qx: float, qy: float) -> float:
    """z of (p - o) x (q - o): positive when q lies left of o -> p."""
    return (px - ox) * (qy - oy) - (py - oy) * (qx - ox)


@exact_entry
def _meetings(
    starts: FloatArray, ends: FloatArray, a: FloatArray, b: FloatArray, boxes: FloatArray, met: NDArray[np.int8]
) -> None:
    """No order of the edges changes what is found: the nearest are asked first, since they stop most flights."""
    order, gap = np.arange(len(boxes)), np.empty(len(boxes))
    for i in range(len(starts)):
        px, py = starts[i, 0], starts[i, 1]
        if len(ends) > len(boxes):  # else sorting takes longer than what it saves
            for g in range(len(boxes)):
                gap[g] = max(boxes[g, 0] - px, px - boxes[g, 2], boxes[g, 1] - py, py - boxes[g, 3])
            order = np.argsort(gap)
        for j in range(len(ends)):
            qx, qy = ends[j, 0], ends[j, 1]
            west, east, south, north = min(px, qx), max(px, qx), min(py, qy), max(py, qy)
            for s in range(len(order)):
                g = order[s]
                if boxes[g, 2] < west or boxes[g, 0] > east or boxes[g, 3] < south or boxes[g, 1] > north:
                    continue
                for k in range(g * BLOCK, min((g + 1) * BLOCK, len(a))):
                    ax, ay, bx, by = a[k, 0], a[k, 1], b[k, 0], b[k, 1]
                    if (ax < west and bx < west) or (ax > east and bx > east):
                        continue
                    if (ay < south and by < south) or (ay > north and by > north):
                        continue
                    across_flight = _side(px, py, qx, qy, ax, ay) * _side(px, py, qx, qy, bx, by)
                    if across_flight > 0.0:
                        continue
                    across_edge = _side(ax, ay, bx, by, px, py) * _side(ax, ay, bx, by, qx, qy)
                    if across_flight < 0.0 and across_edge < 0.0:
                        met[i, j] = CROSSES
                        break
                    if across_edge <= 0.0:
                        met[i, j] = TOUCHES
                if met[i, j] == CROSSES:  # what stopped this flight is asked first for the next, to a place nearby
                    order[s], order[0] = order[0], g
                    break
