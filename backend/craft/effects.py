"""What the craft machine asks for. Its runner carries it out in order; the machine itself touches nothing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from backend.events import Outcome
from backend.reasons import Reason
from backend.search.effects import Record, Refuse
from backend.spec import Place

TimerName = Literal["console_hold", "console_return", "landing", "order", "battery_return"]


@dataclass(frozen=True, slots=True)
class CancelWork:
    """Stop the running work (take-off, flight, turn, planning) at once; its result no longer counts."""


@dataclass(frozen=True, slots=True)
class TakeOff:
    """In the air already: fly to the flight altitude over the place where it is.

    again: of a search that was begun before; from the ground, the battery is asked first whether it lasts for the first
    turn, at `chosen` or where one would be planned, none of `avoid`.
    """

    altitude_relative_m: float
    again: bool = False
    chosen: Place | None = None
    avoid: tuple[Place, ...] = ()


@dataclass(frozen=True, slots=True)
class PlanNext:
    """Choose measurement place `place_number`, none of `avoid`."""

    place_number: int
    avoid: tuple[Place, ...]


@dataclass(frozen=True, slots=True)
class FlyTo:
    """The way round no-fly zones, at the flight altitude, is the work's matter."""

    place_number: int
    place: Place


@dataclass(frozen=True, slots=True)
class Measure:
    """Turn on the spot and listen, for all emitters at once."""

    place_number: int
    attempt: int


@dataclass(frozen=True, slots=True)
class HoldVehicle:
    """Brake and hover where it is."""

    pass


@dataclass(frozen=True, slots=True)
class ReturnHome:
    """Around what may not be flown over, then land at home (fly_home.py)."""


@dataclass(frozen=True, slots=True)
class Land:
    """Where it is."""

    pass


@dataclass(frozen=True, slots=True)
class TakeControl:
    """The operator's explicit deed: commands pass again after somebody else took over."""


@dataclass(frozen=True, slots=True)
class StartTimer:
    """Deliver TimerExpired(name) after this many seconds; a running timer of that name starts again."""

    name: TimerName
    seconds: float


@dataclass(frozen=True, slots=True)
class CancelTimer:
    """Harmless when it does not run."""

    name: TimerName


@dataclass(frozen=True, slots=True)
class LeaveSearch:
    """The craft searches no more. When it was the last one the search is over; outcome None: its belief decides."""

    because: Reason
    outcome: Outcome | None = None


Motion = TakeOff | FlyTo | Measure | ReturnHome | Land
"""Effects that move the vehicle."""

CraftEffect = (
    Record
    | Refuse
    | CancelWork
    | PlanNext
    | HoldVehicle
    | TakeControl
    | StartTimer
    | CancelTimer
    | LeaveSearch
    | Motion
)
