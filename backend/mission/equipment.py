"""What a running mission holds in its hands: ports, and the two or three things that are not the specification's."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from backend.mission.ports import Journal, Publisher
from hardware.direction_finding.antenna import AntennaPattern
from hardware.ports import Clock, DirectionFinder, Receiver, Vehicle


def _ok() -> Literal["ok", "slow", "lost"]:
    return "ok"


@dataclass(frozen=True, slots=True)
class Equipment:
    """Made by the wiring. watch_consoles: False where nobody is meant to watch (headless demo).

    threads: how many the planner may use. software: version, for the record.
    """

    vehicle: Vehicle
    receiver: Receiver
    finder: DirectionFinder
    pattern: AntennaPattern
    journal: Journal
    publisher: Publisher
    clock: Clock
    software: str
    watch_consoles: bool = True
    threads: int = 2
    database: Callable[[], Literal["ok", "slow", "lost"]] = _ok
