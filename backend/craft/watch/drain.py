"""How fast the battery empties in flight."""

from __future__ import annotations

from dataclasses import dataclass

from backend.craft.safety import NOMINAL_DRAIN_PERCENT_S
from hardware.readings import Telemetry

MEASURED_DRAIN_AFTER_S = 60.0
MEASURED_DRAIN_PERCENT = 2.0


@dataclass(slots=True)
class Drain:
    """Battery used a second in the air since the last take-off, the nominal rate until enough was used to tell.

    Time is the charge's own: what a lost link did not bring drained nothing.
    """

    began: tuple[float, float] | None = None
    percent_s: float = NOMINAL_DRAIN_PERCENT_S

    def update(self, telemetry: Telemetry, now_s: float) -> None:
        """Until MEASURED_DRAIN_PERCENT is used the rate stays the nominal one; a fuller battery starts again."""
        charge, at_s = telemetry.battery_percent, telemetry.battery_at_s or now_s
        if telemetry.in_air is False:
            self.began = None
        if not telemetry.in_air or charge is None:
            return
        if self.began is None or charge > self.began[1]:
            self.began = (at_s, charge)
        seconds, used = at_s - self.began[0], self.began[1] - charge
        if seconds >= MEASURED_DRAIN_AFTER_S and used >= MEASURED_DRAIN_PERCENT:
            self.percent_s = used / seconds
