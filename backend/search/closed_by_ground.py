"""Where the ground leaves no room between clearance, ceiling and band: the planner looks for no place there. Pure.

A picture for planning, in cells; what may be flown is judged by the vetoes, way by way.
"""

from __future__ import annotations

import math

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from backend.search.ground import LATERAL_TOLERANCE_M, VERTICAL_TOLERANCE_M, Ground
from backend.spec import FlightSpec

MOST_CELLS = 120
"""Along the longer side."""
FINEST_CELL_M = 10.0
SPECK_CELLS = 3.0
"""What is closed in so few cells is left to the vetoes: each corner costs the search for a way around."""

Numbers = NDArray[np.float64]


def closed_by_ground(
    ground: Ground, flight: FlightSpec, fence: BaseGeometry, origin: tuple[float, float] = (0.0, 0.0)
) -> BaseGeometry | None:
    """Places (m ENU) to which no level way leads from `origin` (home, if nothing else). None: there is none.

    Everything between the two counts, so it is gone through ray by ray.
    """
    if ground.terrain is None or fence.is_empty:
        return None
    from scipy.ndimage import maximum_filter, minimum_filter  # loaded beside the server's start, not before its page

    west, south = np.minimum(fence.bounds[:2], origin)
    east, north = np.maximum(fence.bounds[2:], origin)
    cell = max(FINEST_CELL_M, (east - west) / MOST_CELLS, (north - south) / MOST_CELLS)
    x, y = np.arange(west, east + cell, cell), np.arange(south, north + cell, cell)
    grid = np.stack(np.meshgrid(x, y), axis=-1)
    around = 2 * math.ceil(LATERAL_TOLERANCE_M / cell) + 1
    lowest, highest = ground.bounds_at(grid.reshape(-1, 2))
    lowest = minimum_filter(lowest.reshape(grid.shape[:2]), around, mode="nearest")
    highest = maximum_filter(highest.reshape(grid.shape[:2]), around, mode="nearest")
    away = grid - np.array(origin)
    lowest, highest = _from_origin(lowest, np.minimum, away, cell), _from_origin(highest, np.maximum, away, cell)
    least = highest + flight.minimum_clearance_m + VERTICAL_TOLERANCE_M
    most = lowest + flight.maximum_above_ground_m - VERTICAL_TOLERANCE_M
    least = np.maximum(least, ground.home_amsl_m + flight.minimum_altitude_relative_m)
    most = np.minimum(most, ground.home_amsl_m + flight.maximum_altitude_relative_m)
    strips = _strips(~(least <= most), x, y, 0.51 * cell)
    if not len(strips):
        return None
    outline = shapely.union_all(strips).simplify(cell)
    parts = [part for part in shapely.get_parts(outline) if part.area > SPECK_CELLS * cell**2]
    return shapely.union_all(parts) if parts else None


def _strips(shut: NDArray[np.bool_], x: Numbers, y: Numbers, half: float) -> NDArray[np.object_]:
    """A box for each run of cells (rows, columns) in a row, `half` m beyond their middles: far fewer to unite."""
    edges = np.diff(np.pad(shut, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    row, first = np.nonzero(edges == 1)
    last = np.nonzero(edges == -1)[1] - 1
    return shapely.box(x[first] - half, y[row] - half, x[last] + half, y[row] + half)


def _from_origin(values: Numbers, worst: np.ufunc, grid: Numbers, cell: float) -> Numbers:
    """The worst of the values (rows, columns) between the origin and each cell, whose places (m) from it are `grid`."""
    far = float(np.hypot(grid[..., 0], grid[..., 1]).max()) + cell
    radii = np.arange(0.0, far, cell / 2)
    rays = math.ceil(2 * math.pi * far / cell)
    angles = np.arange(rays) * 2 * math.pi / rays
    at = radii[:, None, None] * np.stack((np.cos(angles), np.sin(angles)), axis=-1)
    column = np.clip(np.rint((at[..., 0] - grid[0, 0, 0]) / cell), 0, values.shape[1] - 1).astype(np.int64)
    row = np.clip(np.rint((at[..., 1] - grid[0, 0, 1]) / cell), 0, values.shape[0] - 1).astype(np.int64)
    along = worst.accumulate(values[row, column], axis=0)
    ring = np.minimum(np.rint(np.hypot(grid[..., 0], grid[..., 1]) / (cell / 2)).astype(np.int64), len(radii) - 1)
    ray = np.rint(np.arctan2(grid[..., 1], grid[..., 0]) * rays / (2 * math.pi)).astype(np.int64) % rays
    return along[ring, ray]
