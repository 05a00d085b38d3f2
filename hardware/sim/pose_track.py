"""The vehicle's pose between two telemetry snapshots, for what is made at moments of its own."""

from __future__ import annotations

from dataclasses import dataclass, field

from hardware.readings import Place, Telemetry
from hardware.sim.world import Pose


@dataclass(frozen=True, slots=True)
class _Fix:
    at_s: float
    pose: Pose


@dataclass(slots=True)
class PoseTrack:
    """Fed with telemetry snapshots; answers where the vehicle was, interpolated between the last two.

    held_s: telemetry older than this is no longer waited for: the vehicle is taken to stand as last heard.
    """

    ground_amsl_m: float = 0.0
    held_s: float = 0.5
    _before: _Fix | None = field(default=None, init=False)
    _after: _Fix | None = field(default=None, init=False)

    def hear(self, telemetry: Telemetry, now_s: float) -> float | None:
        """Take in a snapshot; until when the pose is known (None: not at all yet)."""
        heard = self._fix(telemetry)
        if heard is None:
            return None
        if self._after is None or heard.at_s > self._after.at_s:
            self._before, self._after = self._after or heard, heard
        return max(heard.at_s, now_s - self.held_s)

    def at(self, at_s: float) -> Pose:
        """The pose at `at_s`: linear, headings the short way round, held outside the two snapshots."""
        if self._before is None or self._after is None:
            raise RuntimeError("no pose was heard yet")
        span = self._after.at_s - self._before.at_s
        part = 1.0 if span <= 0 else min(max((at_s - self._before.at_s) / span, 0.0), 1.0)
        a, b = self._before.pose, self._after.pose
        turn = (b.heading_deg - a.heading_deg + 180.0) % 360.0 - 180.0
        place = Place(
            a.place.lat + part * (b.place.lat - a.place.lat),
            a.place.lon + part * (b.place.lon - a.place.lon),
        )
        return Pose(place, a.height_m + part * (b.height_m - a.height_m), (a.heading_deg + part * turn) % 360.0)

    def _fix(self, telemetry: Telemetry) -> _Fix | None:
        if telemetry.position is None or telemetry.heading_deg is None or telemetry.heading_at_s is None:
            return None
        height = telemetry.altitude_relative_m
        if height is None:
            height = (telemetry.altitude_amsl_m or self.ground_amsl_m) - self.ground_amsl_m
        return _Fix(telemetry.heading_at_s, Pose(telemetry.position, max(height, 0.3), telemetry.heading_deg))
