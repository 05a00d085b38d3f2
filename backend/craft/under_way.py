"""Is the vehicle seen to fly where a leg sends it? That it moves proves nothing: it may go on where it went before."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hardware.frame import LocalFrame
from hardware.readings import Place, Telemetry

CLOSING_M_S = 1.0
CLIMBING_M_S = 0.5
THERE_M = 3.0
LOOKS = 5
"""In a row: a vehicle that is refused a leg has told so before."""


@dataclass(slots=True)
class UnderWay:
    """to: where the present leg leads, None between legs."""

    to: Place | None = None
    _seen: int = 0

    def begin(self, to: Place) -> None:
        """A leg is about to be commanded."""
        self.to, self._seen = to, 0

    def end(self) -> None:
        """The leg was flown, or failed."""
        self.to = None

    def look(self, telemetry: Telemetry) -> bool:
        """Whether it has come nearer, or climbs or descends on the spot, for several looks."""
        self._seen = self._seen + 1 if self._obeys(telemetry) else 0
        return self._seen >= LOOKS

    def _obeys(self, telemetry: Telemetry) -> bool:
        north, east = telemetry.velocity_north_m_s, telemetry.velocity_east_m_s
        if self.to is None or telemetry.position is None or north is None or east is None:
            return False
        x, y = LocalFrame(telemetry.position).to_enu(self.to)
        away_m = math.hypot(x, y)
        if away_m < THERE_M:
            return abs(telemetry.velocity_down_m_s or 0.0) > CLIMBING_M_S
        return (east * x + north * y) / away_m > CLOSING_M_S
