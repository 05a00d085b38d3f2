"""Short distances on the ground, for arrival and plausibility only: a sphere is good to 0.5 %."""

from __future__ import annotations

import math

from hardware.readings import GeoPoint

_METRES_PER_DEGREE = 111_195.0


def north_east_m(a: GeoPoint, b: GeoPoint) -> tuple[float, float]:
    """The way from a to b."""
    north = (b.lat_deg - a.lat_deg) * _METRES_PER_DEGREE
    east = math.remainder(b.lon_deg - a.lon_deg, 360.0) * _METRES_PER_DEGREE * math.cos(math.radians(a.lat_deg))
    return north, east


def distance_m(a: GeoPoint, b: GeoPoint) -> float:
    return math.hypot(*north_east_m(a, b))
