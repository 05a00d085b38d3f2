"""The flown track, thinned."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from backend.ports import TrackPoint
from hardware.readings import Telemetry

TRACK_S = 0.5


@dataclass(slots=True)
class Track:
    """Two points a second at most; they collect in `points` until `take`."""

    points: list[TrackPoint] = field(default_factory=list[TrackPoint])
    _tracked_at_s: float = -math.inf

    def update(self, telemetry: Telemetry, now_s: float) -> None:
        """Nothing is kept of a vehicle that is not heard, or whose place, altitude or heading is unknown."""
        position = telemetry.position
        values = (telemetry.altitude_amsl_m, telemetry.altitude_relative_m, telemetry.heading_deg)
        if now_s - self._tracked_at_s < TRACK_S or position is None or None in values or not telemetry.connected:
            return
        amsl, relative, heading = (float(v) for v in values if v is not None)
        self._tracked_at_s = now_s
        self.points.append(
            TrackPoint(
                at_s=now_s,
                lat_deg=position.lat,
                lon_deg=position.lon,
                altitude_amsl_m=amsl,
                altitude_relative_m=relative,
                heading_deg=heading,
                battery_percent=telemetry.battery_percent,
                mode=telemetry.mode,
            )
        )

    def take(self) -> list[TrackPoint]:
        """What has collected since the last call, oldest first."""
        points, self.points = self.points, []
        return points
