"""The vehicle's pose between its reports, for what is made at moments of its own."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

from hardware.readings import HeadingSample, Place, Telemetry
from hardware.sim.world import Pose

BRIDGED_S, BRIDGED_DEG = 2.0, 120.0
"""Between reports further apart the pose is not known: in a turn, the nose may have gone either way round."""
KEPT_S = 60.0


@dataclass(frozen=True, slots=True)
class _Fix:
    at_s: float
    pose: Pose


@dataclass(slots=True)
class PoseTrack:
    """Fed with telemetry, and with the headings since its last report where somebody has kept them; answers where the
    vehicle was, interpolated between the reports around that moment."""

    ground_amsl_m: float = 0.0
    _fixes: deque[_Fix] = field(default_factory=deque[_Fix], init=False)

    @property
    def newest_s(self) -> float | None:
        """When the newest pose was; None before the first."""
        return self._fixes[-1].at_s if self._fixes else None

    def hear(self, telemetry: Telemetry, headings: Sequence[HeadingSample] = ()) -> bool:
        """Take in a snapshot, and `headings`, in time order. False when the vehicle does not know where it is."""
        if telemetry.position is None or telemetry.heading_deg is None or telemetry.heading_at_s is None:
            return False
        height = telemetry.altitude_relative_m
        if height is None:
            height = (telemetry.altitude_amsl_m or self.ground_amsl_m) - self.ground_amsl_m
        height = max(height, 0.3)
        for one in headings:
            self._add(one.at_s, Pose(one.position or telemetry.position, height, one.heading_deg))
        self._add(telemetry.heading_at_s, Pose(telemetry.position, height, telemetry.heading_deg))
        return True

    def at(self, at_s: float) -> Pose | None:
        """The pose at `at_s`: linear, headings the short way round. None: it is not known, since the reports around
        that moment are too far apart, or since none came after it."""
        after = bisect_left(self._fixes, at_s, key=lambda fix: fix.at_s)
        if after == len(self._fixes):
            return None
        b = self._fixes[after]
        if b.at_s == at_s:
            return b.pose
        if after == 0:
            return None
        a = self._fixes[after - 1]
        turn = (b.pose.heading_deg - a.pose.heading_deg + 180.0) % 360.0 - 180.0
        if b.at_s - a.at_s > BRIDGED_S or abs(turn) > BRIDGED_DEG:
            return None
        part = (at_s - a.at_s) / (b.at_s - a.at_s)
        place = Place(
            a.pose.place.lat + part * (b.pose.place.lat - a.pose.place.lat),
            a.pose.place.lon + part * math.remainder(b.pose.place.lon - a.pose.place.lon, 360.0),
        )
        height = a.pose.height_m + part * (b.pose.height_m - a.pose.height_m)
        return Pose(place, height, (a.pose.heading_deg + part * turn) % 360.0)

    def _add(self, at_s: float, pose: Pose) -> None:
        if self._fixes and at_s <= self._fixes[-1].at_s:
            return
        self._fixes.append(_Fix(at_s, pose))
        while at_s - self._fixes[0].at_s > KEPT_S:
            self._fixes.popleft()
