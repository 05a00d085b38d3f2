"""Has the vehicle come home, is it down?"""

from __future__ import annotations

import math
from dataclasses import dataclass

from backend.craft import inputs
from backend.craft.safety import Limits
from backend.craft.state import HOMEWARD, CraftState
from backend.craft.way_home import ABOVE_HOME_M
from backend.reasons.flight import BackAfterRestart, FailsafeFlies
from hardware.readings import Telemetry

LANDED_FOR_S = 1.0


@dataclass(slots=True)
class WayDown:
    """Remembers whether the vehicle was seen flying: what never rose has not landed, unless its motors are off: another
    server may have seen it fly."""

    _flown: bool = False
    _on_ground_since_s: float | None = None

    def look(self, telemetry: Telemetry, now_s: float, state: CraftState, limits: Limits) -> list[inputs.CraftInput]:
        """Above home while returning, and on the ground for a second after a flight."""
        found: list[inputs.CraftInput] = []
        if state.phase == "returning" and _above_home(telemetry, limits):
            found.append(inputs.HomeReached())
        self._flown |= telemetry.in_air is True
        flown = state.took_off or self._flown or (_flew_before(state) and telemetry.armed is False)
        if not flown or telemetry.in_air is not False or not telemetry.connected:
            self._on_ground_since_s = None
        elif self._on_ground_since_s is None:
            self._on_ground_since_s = now_s
        elif now_s - self._on_ground_since_s >= LANDED_FOR_S:
            found.append(inputs.Landed())
        return found


def _flew_before(state: CraftState) -> bool:
    """On its way down, or left in the air by the server before."""
    back = isinstance(state.phase_reason, BackAfterRestart | FailsafeFlies)
    return state.phase in HOMEWARD or (state.phase == "hold" and back)


def _above_home(telemetry: Telemetry, limits: Limits) -> bool:
    position = telemetry.position
    return position is not None and math.hypot(*limits.frame.to_enu(position)) < ABOVE_HOME_M
