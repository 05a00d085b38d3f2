"""WGS84 to metres around home and back, by the two radii of curvature at home (centimetres within a few km)."""

from __future__ import annotations

import math
from dataclasses import dataclass

_A = 6378137.0
_E2 = 6.69437999014e-3


@dataclass(frozen=True, slots=True)
class HomeFrame:
    """The place of take-off: degrees WGS84 and metres AMSL. North, east and up are metres from it."""

    lat_deg: float
    lon_deg: float
    amsl_m: float

    def __post_init__(self) -> None:
        if not (abs(self.lat_deg) <= 89.0 and abs(self.lon_deg) <= 180.0 and math.isfinite(self.amsl_m)):
            raise ValueError(
                f"Home {self.lat_deg}, {self.lon_deg}, {self.amsl_m} is no usable place: "
                "give latitude -89..89, longitude -180..180 and metres above mean sea level."
            )

    def _metres_per_radian(self) -> tuple[float, float]:
        s = math.sin(math.radians(self.lat_deg))
        w = math.sqrt(1.0 - _E2 * s * s)
        meridian = _A * (1.0 - _E2) / w**3  # M = a (1 - e^2) / (1 - e^2 sin^2)^(3/2)
        prime_vertical = _A / w  # N = a / sqrt(1 - e^2 sin^2)
        return meridian, prime_vertical * math.cos(math.radians(self.lat_deg))

    def to_geo(self, north: float, east: float) -> tuple[float, float]:
        """(lat_deg, lon_deg)."""
        per_lat, per_lon = self._metres_per_radian()
        return self.lat_deg + math.degrees(north / per_lat), self.lon_deg + math.degrees(east / per_lon)

    def to_local(self, lat_deg: float, lon_deg: float) -> tuple[float, float]:
        """(north, east) in metres."""
        per_lat, per_lon = self._metres_per_radian()
        return math.radians(lat_deg - self.lat_deg) * per_lat, math.radians(lon_deg - self.lon_deg) * per_lon
