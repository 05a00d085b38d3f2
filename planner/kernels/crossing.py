"""Which straight flights meet which borders: every pair of places against every edge, compiled.

A detailed coast line has a thousand corners, so a visibility graph asks a thousand million times.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from planner.compiling import exact, exact_entry
from planner.geometry import edges
from planner.types import FloatArray, Region

FREE, TOUCHES, CROSSES = 0, 1, 2


def meetings(starts: FloatArray, ends: FloatArray, region: Region) -> NDArray[np.int8]:
    """(n, m) int8 for the segments from (n, 2) `starts` to (m, 2) `ends`, m ENU.

    CROSSES: properly through an edge of the region. TOUCHES: has a point in common with one (a corner, a piece of it)
    but crosses none. FREE: neither.
    """
    met = np.zeros((len(starts), len(ends)), dtype=np.int8)
    a, b = edges(region)
    if met.size and len(a):
        contiguous = np.ascontiguousarray
        _meetings(contiguous(starts, float), contiguous(ends, float), contiguous(a), contiguous(b), met)
    return met


@exact
def _side(ox: float, oy: float, px: float, py: float, qx: float, qy: float) -> float:
    """z of (p - o) x (q - o): positive when q lies left of o -> p."""
    return (px - ox) * (qy - oy) - (py - oy) * (qx - ox)


@exact_entry
def _meetings(starts: FloatArray, ends: FloatArray, a: FloatArray, b: FloatArray, met: NDArray[np.int8]) -> None:
    for i in range(len(starts)):
        px, py = starts[i, 0], starts[i, 1]
        for j in range(len(ends)):
            qx, qy = ends[j, 0], ends[j, 1]
            west, east, south, north = min(px, qx), max(px, qx), min(py, qy), max(py, qy)
            for k in range(len(a)):
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
