"""What a craft holds in its hands: vehicle, receiver, direction finder, antenna, and the clock of the mission."""

from __future__ import annotations

from dataclasses import dataclass

from backend.ports import Publisher
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
