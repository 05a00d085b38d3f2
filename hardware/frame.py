"""WGS84 to local east-north-up metres and back, and compass bearings to mathematical angles and back."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import median

import numpy as np
import pymap3d
from numpy.typing import NDArray

from hardware.readings import Place

Average = Callable[[Sequence[float]], float]


@dataclass(frozen=True, slots=True)
class LocalFrame:
    """ENU metres on the ellipsoid's tangent plane at `origin`; good to centimetres within a few kilometres."""

    origin: Place

    def to_enu(self, point: Place) -> tuple[float, float]:
        """(east, north) in metres."""
        east, north, _ = pymap3d.geodetic2enu(point.lat, point.lon, 0.0, self.origin.lat, self.origin.lon, 0.0)
        return float(east), float(north)

    def to_enu_points(self, lon_lat: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 2) longitude, latitude in degrees -> (n, 2) east, north in metres."""
        lon, lat = lon_lat[:, 0], lon_lat[:, 1]
        east, north, _ = pymap3d.geodetic2enu(lat, lon, 0.0, self.origin.lat, self.origin.lon, 0.0)
        return np.column_stack([east, north])

    def to_geo(self, east: float, north: float) -> Place:
        """(east, north) in metres at the origin's height to WGS84 degrees."""
        lat, lon, _ = pymap3d.enu2geodetic(east, north, 0.0, self.origin.lat, self.origin.lon, 0.0)
        return Place(float(lat), float(lon))

    def to_lon_lat(self, points: NDArray[np.float64]) -> list[tuple[float, float]]:
        """(n, 2) east, north in metres -> n times (lon, lat) in degrees."""
        east, north = points[:, 0], points[:, 1]
        lat, lon, _ = pymap3d.enu2geodetic(east, north, 0.0, self.origin.lat, self.origin.lon, 0.0)
        return list(zip(lon.tolist(), lat.tolist(), strict=True))


def middle_of(lat_deg: Sequence[float], lon_deg: Sequence[float], average: Average = median) -> Place:
    """Of places near one another, on either side of the dateline, too."""
    lon = average(np.unwrap(lon_deg, period=360.0).tolist())
    return Place(average(lat_deg), lon if -180.0 <= lon <= 180.0 else math.remainder(lon, 360.0))


def compass_to_angle(bearing_deg: float) -> float:
    """Degrees clockwise from true north -> radians counter-clockwise from east, in (-pi, pi]."""
    return math.remainder(math.pi / 2 - math.radians(bearing_deg), 2 * math.pi)


def angle_to_compass(angle: float) -> float:
    """Radians counter-clockwise from east -> degrees clockwise from true north, in [0, 360)."""
    return (90.0 - math.degrees(angle)) % 360.0 % 360.0
