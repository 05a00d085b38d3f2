"""Has the vehicle come home, is it down?"""

from __future__ import annotations

import math
from dataclasses import dataclass

from backend.craft import inputs
from backend.craft.safety import Limits
from backend.craft.state import HOMEWARD, CraftState
from backend.craft.way_home import ABOVE_HOME_M
from hardware.readings import Telemetry

LANDED_FOR_S = 1.0


@dataclass(slots=True)
class WayDown:
    """Remembers whether the vehicle was seen flying: what never rose has not landed."""

    _flown: bool = False
    _on_ground_since_s: float | None = None

    def look(self, telemetry: Telemetry, now_s: float, state: CraftState, limits: Limits) -> list[inputs.CraftInput]:
        """Above home while returning, and on the ground for a second after a flight."""
        found: list[inputs.CraftInput] = []
        if state.phase == "returning" and _above_home(telemetry, limits):
            found.append(inputs.HomeReached())
        self._flown |= telemetry.in_air is True
        flown = state.took_off or self._flown or (state.phase in HOMEWARD and telemetry.armed is False)
        if not flown or telemetry.in_air is not False or not telemetry.connected:
            self._on_ground_since_s = None
        elif self._on_ground_since_s is None:
            self._on_ground_since_s = now_s
        elif now_s - self._on_ground_since_s >= LANDED_FOR_S:
            found.append(inputs.Landed())
        return found


def _above_home(telemetry: Telemetry, limits: Limits) -> bool:
    position = telemetry.position
    return position is not None and math.hypot(*limits.frame.to_enu(position)) < ABOVE_HOME_M
