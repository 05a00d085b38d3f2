"""The rate of the autopilot's clock: while it is odd, no heading can be dated, and no bearing is worth anything."""

from __future__ import annotations

from dataclasses import dataclass

from backend.craft import inputs
from hardware.readings import Telemetry
from hardware.reasons.vehicle_news import ClockRateOdd


@dataclass(slots=True)
class ClockWatch:
    """Of one craft."""

    _odd: bool = False

    def look(self, telemetry: Telemetry) -> list[inputs.CraftInput]:
        """That it is odd, and that it is so no longer, each once. Of a vehicle that is not heard nothing is new."""
        rate = telemetry.odd_clock_rate
        if not telemetry.connected or (rate is not None) == self._odd:
            return []
        self._odd = rate is not None
        return [inputs.ClockAgrees() if rate is None else inputs.ClockOdd(ClockRateOdd(rate))]
