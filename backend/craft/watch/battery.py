"""Does the battery still suffice, and who was alerted when it did not?"""

from __future__ import annotations

from dataclasses import dataclass, replace

from backend.craft import inputs
from backend.craft.safety import BATTERY_STALE_S, Limits, Situation, battery_vetoes
from backend.craft.state import AUTOMATIC, HOMEWARD, CraftState
from backend.events import Phase

RECOVERED_PERCENT = 2.0
"""A low battery counts as recovered with this much to spare: a charge at the limit raises one alert."""


@dataclass(slots=True)
class BatteryWatch:
    """Alerts once a cause, and again when the cause or who flies changes."""

    _alerted: tuple[str, str] = ("", "")
    """The code of the veto, and who flew then: a change of either raises an alert again."""
    _unheard_since_s: float | None = None

    def look(self, situation: Situation, state: CraftState, limits: Limits) -> list[inputs.CraftInput]:
        """A battery that no longer suffices in the air, and its recovery, each once."""
        telemetry = situation.telemetry
        if not telemetry.in_air or not telemetry.connected:
            return []
        vetoes = battery_vetoes(limits, situation)
        if telemetry.battery_percent is not None:
            self._unheard_since_s = None
        elif vetoes:
            if self._unheard_since_s is None:
                self._unheard_since_s = situation.now_s
            if situation.now_s - max(self._unheard_since_s, situation.heard_since_s) < BATTERY_STALE_S:
                return []
        if vetoes:
            alerted = (vetoes[0].code, flown_by(state.phase))
            if alerted != self._alerted:
                self._alerted = alerted
                return [inputs.BatteryLow(vetoes[0])]
        elif self._alerted != ("", "") or any(alert.topic == "battery" for alert in state.open_alerts):
            spare = replace(limits, reserve_percent=limits.reserve_percent + RECOVERED_PERCENT)
            if not battery_vetoes(spare, situation):
                self._alerted = ("", "")
                return [inputs.BatteryReported()]
        return []


def flown_by(phase: Phase) -> str:
    """Who has to act on a low battery: the mission itself does when it flies, people when it is held."""
    return "mission" if phase in AUTOMATIC else "home" if phase in HOMEWARD else "people"
