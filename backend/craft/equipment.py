"""What a craft holds in its hands: vehicle, receiver, direction finder, antenna, and the clock of the mission."""

from __future__ import annotations

from dataclasses import dataclass, replace

from backend.events import AntennaFact
from backend.ports import Publisher
from backend.search.antenna import corrected, pattern_of
from backend.spec import SensorSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.ports import Clock, DirectionFinder, Receiver, Vehicle


@dataclass(frozen=True, slots=True)
class CraftEquipment:
    """Made by the wiring. threads: how many the planner may use. watch_consoles: False where nobody is meant to watch
    (headless demo)."""

    craft_id: str
    vehicle: Vehicle
    receiver: Receiver
    finder: DirectionFinder
    pattern: AntennaPattern
    clock: Clock
    publisher: Publisher
    threads: int = 2
    watch_consoles: bool = True

    def flown_with(self, sensor: SensorSpec, begun_with: AntennaFact | None = None) -> CraftEquipment:
        """The same for one mission, its antenna turned by what the bearings are known to be off by. begun_with: the
        antenna that it has flown with, turned already, which it keeps whatever this server was given."""
        turned = corrected(self.pattern, sensor.bearing_offset_deg) if begun_with is None else pattern_of(begun_with)
        return replace(self, pattern=turned)
