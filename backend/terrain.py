"""The heights of an area as one value: a grid of latitudes and longitudes, with a digest that names it for good.

Heights are metres above mean sea level (EGM96 or EGM2008, which differ by less than a metre), as an autopilot's are.
"""

from __future__ import annotations

import hashlib
import json
import math
import zlib
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hardware.readings import Place

Heights = NDArray[np.float32]
Numbers = NDArray[np.float64]

BEYOND = 0.75
"""A node stands for half a cell around it. Up to this share of a cell beyond the last node the ground is known as well,
so that files laid side by side leave no gap."""
METRES_PER_DEGREE = 111_195.0
MOST_NODES = 16 * 2**20


class TerrainDamaged(ValueError):
    """These bytes are not a stored terrain."""


@dataclass(frozen=True, eq=False)
class Terrain:
    """heights: (rows, columns), m AMSL, from north to south and from west to east; NaN where nobody knows.
    north_deg, west_deg: of the first node. lat_step_deg, lon_step_deg: between nodes. sources: names of the files."""

    north_deg: float
    west_deg: float
    lat_step_deg: float
    lon_step_deg: float
    heights: Heights
    sources: tuple[str, ...] = field(default=())

    @property
    def spacing_m(self) -> float:
        """The finer of the two distances between nodes."""
        return min(self.lat_spacing_m, self.lon_spacing_m)

    @property
    def lat_spacing_m(self) -> float:
        """Between nodes, from north to south."""
        return self.lat_step_deg * METRES_PER_DEGREE

    @property
    def lon_spacing_m(self) -> float:
        """Between nodes, from west to east, in the middle of the grid."""
        middle = self.north_deg - self.lat_step_deg * (self.heights.shape[0] - 1) / 2
        return self.lon_step_deg * METRES_PER_DEGREE * math.cos(math.radians(middle))

    def at(self, lat_deg: Numbers, lon_deg: Numbers) -> Numbers:
        """Heights (n,) by bilinear interpolation; NaN outside, and where one of the four nodes around is unknown."""
        rows, columns = self.heights.shape
        row, column = self._indices(lat_deg, lon_deg)
        row, known_row = _within(row, rows)
        column, known_column = _within(column, columns)
        top = np.minimum(row.astype(np.int64), max(rows - 2, 0))
        left = np.minimum(column.astype(np.int64), max(columns - 2, 0))
        down, right = np.minimum(top + 1, rows - 1), np.minimum(left + 1, columns - 1)
        v, u = row - top, column - left
        nodes = self.heights
        found = (1 - v) * ((1 - u) * nodes[top, left] + u * nodes[top, right]) + v * (
            (1 - u) * nodes[down, left] + u * nodes[down, right]
        )
        return np.where(known_row & known_column, found, np.nan)

    def nodes_near(self, lat_deg: Numbers, lon_deg: Numbers, within_m: float) -> Numbers:
        """Heights (k,) of the nodes that are nearest to one of the points (n,) and at most `within_m` from it.

        Between its nodes a bilinear surface has no summit and no hollow, so these are all that lie near the points.
        """
        rows, columns = self.heights.shape
        row, column = self._indices(lat_deg, lon_deg)
        nearest_row, nearest_column = np.rint(row), np.rint(column)
        off = np.hypot((row - nearest_row) * self.lat_spacing_m, (column - nearest_column) * self.lon_spacing_m)
        inside = (nearest_row >= 0) & (nearest_row < rows) & (nearest_column >= 0) & (nearest_column < columns)
        near = inside & (off <= within_m)
        return self.heights[nearest_row[near].astype(np.int64), nearest_column[near].astype(np.int64)].astype(float)

    def _indices(self, lat_deg: Numbers, lon_deg: Numbers) -> tuple[Numbers, Numbers]:
        """Row and column (n,), with fractions; a longitude is the one of its turns that is nearest to the grid."""
        east_of_west = lon_deg - self.west_deg
        middle = self.lon_step_deg * (self.heights.shape[1] - 1) / 2
        east_of_west = east_of_west - 360.0 * np.rint((east_of_west - middle) / 360.0)
        return (self.north_deg - lat_deg) / self.lat_step_deg, east_of_west / self.lon_step_deg

    @cached_property
    def digest(self) -> str:
        """SHA-256 of grid and heights: the same ground has the same name on every machine."""
        return hashlib.sha256(self._head() + self._body()).hexdigest()

    def to_bytes(self) -> bytes:
        """A line of JSON, then the heights, deflated."""
        return self._head() + b"\n" + zlib.compress(self._body(), 6)

    def _head(self) -> bytes:
        rows, columns = self.heights.shape
        said = {
            "north_deg": self.north_deg,
            "west_deg": self.west_deg,
            "lat_step_deg": self.lat_step_deg,
            "lon_step_deg": self.lon_step_deg,
            "rows": rows,
            "columns": columns,
            "sources": self.sources,
        }
        return json.dumps(said).encode()

    def _body(self) -> bytes:
        return np.ascontiguousarray(self.heights, dtype="<f4").tobytes()


def unknown_terrain(place: Place) -> Terrain:
    """Ground of which nothing is known any more: every way over it is refused."""
    return Terrain(place.lat + 0.05, place.lon - 0.05, 0.1, 0.1, np.full((2, 2), np.nan, np.float32))


def terrain_from(stored: bytes) -> Terrain:
    """What `to_bytes` gave. Raises TerrainDamaged."""
    head, _, body = stored.partition(b"\n")
    try:
        said = json.loads(head)
        rows, columns = int(said["rows"]), int(said["columns"])
        if not 0 < rows * columns <= MOST_NODES:
            raise TerrainDamaged("no size")
        unpacker = zlib.decompressobj()
        raw = unpacker.decompress(body, 4 * rows * columns)
        heights = np.frombuffer(raw, dtype="<f4").reshape(rows, columns).astype(np.float32)
        north, west, lat_step, lon_step = (
            float(said[name]) for name in ("north_deg", "west_deg", "lat_step_deg", "lon_step_deg")
        )
        return Terrain(north, west, lat_step, lon_step, heights, tuple(str(name) for name in said["sources"]))
    except (ValueError, KeyError, TypeError, zlib.error) as error:
        raise TerrainDamaged(str(error)) from error


def _within(index: Numbers, count: int) -> tuple[Numbers, NDArray[np.bool_]]:
    """Indices held between the first and the last node, and which of them were near enough to be held."""
    with np.errstate(invalid="ignore"):
        known = (index >= -BEYOND) & (index <= count - 1 + BEYOND)
    return np.clip(np.nan_to_num(index), 0.0, count - 1.0), known
