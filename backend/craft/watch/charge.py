"""The charge of a craft that flies for no mission: nobody knows what its way home takes, so a share counts as low."""

from __future__ import annotations

from dataclasses import dataclass

from backend.craft import inputs
from backend.craft.safety import BATTERY_STALE_S
from backend.craft.watch.battery import RECOVERED_PERCENT
from backend.reasons.flight import BatteryRunsLow
from backend.reasons.safety import BatterySilent
from hardware.readings import Telemetry

LOW_PERCENT, LAST_PERCENT = 25.0, 12.5
"""The reserve that a mission keeps unless it says otherwise, and half of it: told again."""


@dataclass(slots=True)
class ChargeWatch:
    """Each step down once, and that it is over."""

    _told: tuple[str, float] | None = None
    """What was told last: its code, and below which charge."""

    def look(self, telemetry: Telemetry, now_s: float) -> list[inputs.CraftInput]:
        """Of a vehicle that is heard. One that never reported a charge has none to tell of."""
        charge, at_s = telemetry.battery_percent, telemetry.battery_at_s
        if not telemetry.connected or charge is None:
            return []
        silent = at_s is not None and (telemetry.heard_at_s or now_s) - at_s > BATTERY_STALE_S
        spare = 0.0 if self._told is None else RECOVERED_PERCENT
        below = next((least for least in (LAST_PERCENT, LOW_PERCENT) if charge < least + spare), None)
        because = BatterySilent() if silent else None if below is None else BatteryRunsLow(charge)
        told = None if because is None else (because.code, 0.0 if silent or below is None else below)
        before, self._told = self._told, told
        if told == before:
            return []
        return [inputs.BatteryReported() if because is None else inputs.ChargeLow(because)]
