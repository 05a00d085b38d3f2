"""Short distances on the ground, for arrival and plausibility only: a sphere is good to 0.5 %."""

from __future__ import annotations

import math

from hardware.readings import Place

_METRES_PER_DEGREE = 111_195.0


def north_east_m(a: Place, b: Place) -> tuple[float, float]:
    """The way from a to b."""
    north = (b.lat - a.lat) * _METRES_PER_DEGREE
    east = math.remainder(b.lon - a.lon, 360.0) * _METRES_PER_DEGREE * math.cos(math.radians(a.lat))
    return north, east


def distance_m(a: Place, b: Place) -> float:
    """Between two places, whatever their altitudes."""
    return math.hypot(*north_east_m(a, b))
