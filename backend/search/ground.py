"""The ground under a flight: what lies below a way at worst, and how high a way is flown over it. Pure.

A mission's band is above its home; clearance and ceiling are above the ground. Without terrain the ground is taken to
be flat at the home's height, and the band alone holds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pymap3d
from numpy.typing import NDArray
from shapely import contains_xy, prepare
from shapely.geometry.base import BaseGeometry

from backend.terrain import Terrain
from hardware.frame import LocalFrame
from hardware.readings import Place

LATERAL_TOLERANCE_M = 10.0
"""A vehicle flies within this beside its way: wind, GPS, and what the terrain itself is off by."""
VERTICAL_TOLERANCE_M = 3.0
"""A vehicle that flies level keeps its altitude within this."""
COARSEST_SAMPLE_M = 5.0
FINEST_SAMPLE_M = 2.0

Points = NDArray[np.float64]
Way = Sequence[tuple[float, float]]


@dataclass(frozen=True, slots=True)
class Below:
    """The ground anywhere within tolerance of a way, m AMSL."""

    lowest_m: float
    highest_m: float


@dataclass(frozen=True, slots=True)
class Ground:
    """frame: its origin is the home. home_amsl_m: as the autopilot says. terrain None: none is known.

    Where terrain and autopilot differ about the home's height, the ground may be as either says: clearance is asked
    above the higher, the ceiling above the lower.
    """

    frame: LocalFrame
    home_amsl_m: float
    terrain: Terrain | None = None

    @property
    def home_by_terrain_m(self) -> float | None:
        """The home's height AMSL as the terrain has it; None: it does not know."""
        return None if self.terrain is None else _known(self.terrain, self.frame.origin)

    def height_at(self, place: Place) -> float | None:
        """The ground's height AMSL at a place; None where the terrain does not know it."""
        return self.home_amsl_m if self.terrain is None else _known(self.terrain, place)

    def below(self, way: Way, beside_m: float = LATERAL_TOLERANCE_M) -> Below | None:
        """At worst, under a way of one or more points (m ENU) and as far beside it. None: part of it is not known."""
        if self.terrain is None:
            return Below(self.home_amsl_m, self.home_amsl_m)
        lat, lon = self._to_geo(_corridor(way, sample_m(self.terrain), beside_m))
        heights = self.terrain.at(lat, lon)
        if not np.isfinite(heights).all():
            return None
        nodes = self.terrain.nodes_near(lat, lon, sample_m(self.terrain))
        every = np.concatenate((heights, nodes[np.isfinite(nodes)]))
        off = self._home_off_m
        return Below(float(every.min()) + min(off, 0.0), float(every.max()) + max(off, 0.0))

    def bounds_at(self, points: Points) -> tuple[Points, Points]:
        """The lowest and the highest that the ground may be right at points (n, 2) m ENU, m AMSL; infinite: unknown."""
        if self.terrain is None:
            return np.full(len(points), self.home_amsl_m), np.full(len(points), self.home_amsl_m)
        heights, off = self.terrain.at(*self._to_geo(points)), self._home_off_m
        unknown = np.isnan(heights)
        lowest, highest = heights + min(off, 0.0), heights + max(off, 0.0)
        return np.where(unknown, -np.inf, lowest), np.where(unknown, np.inf, highest)

    def heights_at(self, points: Points) -> Points:
        """The ground's heights (n,) right at points (n, 2) m ENU, m AMSL; NaN where the terrain does not know."""
        if self.terrain is None:
            return np.full(len(points), self.home_amsl_m)
        return self.terrain.at(*self._to_geo(points))

    def profile(self, way: Way, points: int = 200) -> tuple[Points, Points]:
        """Distances along a way (m) and the ground's heights below it (m AMSL, NaN unknown), straight below."""
        line = np.asarray(way, dtype=float)
        lengths = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
        along: Points = np.linspace(0.0, float(lengths[-1]), points)
        at = np.column_stack([np.interp(along, lengths, line[:, axis]) for axis in (0, 1)])
        return along, self.heights_at(at)

    def known_share(self, area: BaseGeometry) -> float:
        """Which share (0..1) of an area (m ENU) the terrain knows, in steps of a hundredth of its width."""
        heights = self._heights_in(area)
        return float(np.isfinite(heights).mean()) if len(heights) else 0.0

    def highest_in(self, area: BaseGeometry) -> float | None:
        """The highest ground in an area (m ENU) as far as it is known, m AMSL; for a return across any of it."""
        if self.terrain is None:
            return self.home_amsl_m
        heights = self._heights_in(area)
        heights = heights[np.isfinite(heights)]
        return float(heights.max()) + max(self._home_off_m, 0.0) if len(heights) else None

    def _heights_in(self, area: BaseGeometry) -> Points:
        if self.terrain is None or area.is_empty:
            return np.empty(0)
        west, south, east, north = area.bounds
        step = max(sample_m(self.terrain), max(east - west, north - south) / 400.0)
        x, y = np.meshgrid(np.arange(west, east + step, step), np.arange(south, north + step, step))
        return self.terrain.at(*self._to_geo(_inside(area, np.column_stack((x.ravel(), y.ravel())))))

    @property
    def _home_off_m(self) -> float:
        """How much higher the autopilot has the home than the terrain."""
        by_terrain = self.home_by_terrain_m
        return 0.0 if by_terrain is None else self.home_amsl_m - by_terrain

    def _to_geo(self, points: Points) -> tuple[Points, Points]:
        origin = self.frame.origin
        lat, lon, _ = pymap3d.enu2geodetic(points[:, 0], points[:, 1], 0.0, origin.lat, origin.lon, 0.0)
        return np.asarray(lat, dtype=float), np.asarray(lon, dtype=float)


def sample_m(terrain: Terrain) -> float:
    """The distance between the points that are looked at: finer than the terrain's own."""
    return min(max(terrain.spacing_m / 3.0, FINEST_SAMPLE_M), COARSEST_SAMPLE_M)


def _known(terrain: Terrain, place: Place) -> float | None:
    height = float(terrain.at(np.array([place.lat]), np.array([place.lon]))[0])
    return height if math.isfinite(height) else None


def _corridor(way: Way, step_m: float, reach: float) -> Points:
    """Points (n, 2) at most `step_m` apart over everything within `reach` (m) of the way."""
    line = [np.asarray(point, dtype=float) for point in way]
    legs = list(pairwise(line)) or [(line[0], line[0])]
    across = np.linspace(-reach, reach, math.ceil(2 * reach / step_m) + 1)
    found: list[Points] = []
    for start, end in legs:
        length = math.dist(start, end)
        direction = (end - start) / length if length > 0.0 else np.array([1.0, 0.0])
        beside = np.array([-direction[1], direction[0]])
        along = np.linspace(-reach, length + reach, math.ceil((length + 2 * reach) / step_m) + 1)
        points = start + along[:, None, None] * direction + across[None, :, None] * beside
        found.append(points.reshape(-1, 2))
    return np.concatenate(found)


def _inside(area: BaseGeometry, points: Points) -> Points:
    prepare(area)
    return points[contains_xy(area, points[:, 0], points[:, 1])]
