"""Does the battery still suffice, and who was alerted when it did not?"""

from __future__ import annotations

from dataclasses import dataclass, replace

from backend.craft import inputs
from backend.craft.endurance import landing_s
from backend.craft.safety import (
    BATTERY_STALE_S,
    BatteryStage,
    Limits,
    Situation,
    battery_to_return_percent,
    battery_vetoes,
)
from backend.craft.state import AUTOMATIC, HOMEWARD, CraftState
from backend.craft.way_home import legs_home
from backend.events import Phase

LAST_SHARE = 0.5
"""Of the reserve: a charge that leaves less is the last to return with."""
LAND_SPARE_PERCENT = 5.0
"""A charge that is no further above what the landing here takes is for landing here."""
RECOVERED_PERCENT = 2.0
"""A low battery counts as recovered with this much to spare: a charge at the limit raises one alert."""


DEPTH: dict[BatteryStage, int] = {"return": 0, "last": 1, "land": 2}
DEEPER_FOR_S = 5.0


@dataclass(slots=True)
class BatteryWatch:
    """Alerts once a cause, and again when the cause, who flies, or the depth changes."""

    _alerted: tuple[str, ...] = ()
    """The code of the veto, who flew then, and how low it was: a change of any raises an alert again."""
    _unheard_since_s: float | None = None
    _stage: BatteryStage = "return"
    _deeper_since_s: float | None = None

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
            stage = self._settled(battery_stage(limits, situation), situation.now_s)
            alerted = (vetoes[0].code, flown_by(state.phase), stage)
            if alerted != self._alerted:
                self._alerted = alerted
                return [inputs.BatteryLow(vetoes[0], stage)]
        elif self._alerted or any(alert.topic == "battery" for alert in state.open_alerts):
            spare = replace(limits, reserve_percent=limits.reserve_percent + RECOVERED_PERCENT)
            if not battery_vetoes(spare, situation):
                self._alerted = ()
                return [inputs.BatteryReported()]
        if not vetoes:
            self._stage, self._deeper_since_s = "return", None
        return []

    def _settled(self, stage: BatteryStage, now_s: float) -> BatteryStage:
        """A deeper stage counts once it has lasted: no single reading makes a vehicle land."""
        if DEPTH[stage] <= DEPTH[self._stage]:
            self._stage, self._deeper_since_s = stage, None
        elif self._deeper_since_s is None:
            self._deeper_since_s = now_s
        elif now_s - self._deeper_since_s >= DEEPER_FOR_S:
            self._stage, self._deeper_since_s = stage, None
        return self._stage


def flown_by(phase: Phase) -> str:
    """Who has to act on a low battery: the mission itself does when it flies, people when it is held."""
    return "mission" if phase in AUTOMATIC else "home" if phase in HOMEWARD else "people"


def battery_stage(limits: Limits, situation: Situation) -> BatteryStage:
    """How low a battery is that no longer leaves the reserve. One whose charge is not known: it should return."""
    telemetry, endurance = situation.telemetry, situation.endurance
    charge, position, height = telemetry.battery_percent, telemetry.position, telemetry.altitude_relative_m
    if charge is None or position is None:
        return "return"
    height = limits.altitude_relative_m if height is None else height
    down = endurance.way_percent((), limits.speed_m_s, landing_s(height))
    if charge < down + LAND_SPARE_PERCENT and legs_home(limits.problem, limits.frame.to_enu(position)):
        return "land"
    spare = charge - battery_to_return_percent(limits, position, endurance, height)
    return "last" if spare < LAST_SHARE * limits.reserve_percent else "return"
