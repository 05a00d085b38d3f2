"""When does a vehicle hover? Slow and on one spot for a while, by its own positions. Pure."""

from __future__ import annotations

from hardware.autopilot.ground import distance_m
from hardware.readings import Place

SLOW_M_S = 1.0
SPOT_M = 2.0
SETTLED_S = 2.0
"""Seconds of being slow, within SPOT_M of where that began. PX4 flies past the point where it stops: there it is slow
for a moment, with metres of its way back still to go."""


class Hover:
    """Sees one position after the other."""

    def __init__(self) -> None:
        self._since_s: float | None = None
        self._spot: Place | None = None

    def see(self, place: Place, speed_m_s: float | None, at_s: float, allowed: bool = True) -> bool:
        """True once it hovers. at_s: of this position; allowed False: not where it should be, so it starts again."""
        moved = self._spot is None or distance_m(self._spot, place) > SPOT_M
        if not allowed or speed_m_s is None or speed_m_s >= SLOW_M_S:
            self._since_s = self._spot = None
        elif self._since_s is None or moved:
            self._since_s, self._spot = at_s, place
        return self._since_s is not None and at_s - self._since_s >= SETTLED_S
