"""What the mission machine asks for. The runner carries it out in order; the machine itself touches nothing."""

from __future__ import annotations

from dataclasses import dataclass

from backend.events import Event
from backend.mission.inputs import TimerName
from backend.spec import Place


@dataclass(frozen=True, slots=True)
class Record:
    """Append this fact to the journal, then show it."""

    event: Event


@dataclass(frozen=True, slots=True)
class Reply:
    """Answer the command."""

    command_id: str
    accepted: bool
    reason: str
    remedy: str


@dataclass(frozen=True, slots=True)
class CancelWork:
    """Stop the running step (take-off, flight, turn, planning) at once; its result no longer counts."""


@dataclass(frozen=True, slots=True)
class TakeOff:
    altitude_relative_m: float


@dataclass(frozen=True, slots=True)
class SearchElsewhere:
    """From now on in the area that was just changed."""


@dataclass(frozen=True, slots=True)
class UpdateBelief:
    """Fold all counted bearings into the belief. Survives CancelWork: it moves nothing."""


@dataclass(frozen=True, slots=True)
class PlanNext:
    """Choose measurement place `place_number`, none of `avoid`."""

    place_number: int
    avoid: tuple[Place, ...]


@dataclass(frozen=True, slots=True)
class FlyTo:
    place_number: int
    place: Place
    altitude_amsl_m: float
    speed_m_s: float


@dataclass(frozen=True, slots=True)
class Measure:
    """Turn once on the spot and listen."""

    place_number: int
    attempt: int


@dataclass(frozen=True, slots=True)
class HoldVehicle:
    pass


@dataclass(frozen=True, slots=True)
class ReturnHome:
    """The autopilot's own return. `hold_first`: brake before it (abort)."""

    hold_first: bool = False


@dataclass(frozen=True, slots=True)
class Land:
    pass


@dataclass(frozen=True, slots=True)
class ReleasePilotLatch:
    pass


@dataclass(frozen=True, slots=True)
class StartTimer:
    """Deliver TimerExpired(name) after so many seconds; a running timer of that name starts anew."""

    name: TimerName
    seconds: float


@dataclass(frozen=True, slots=True)
class CancelTimer:
    name: TimerName


Flight = TakeOff | FlyTo | Measure | ReturnHome | Land
"""Effects that move the vehicle."""

Effect = (
    Record
    | Reply
    | CancelWork
    | SearchElsewhere
    | UpdateBelief
    | PlanNext
    | HoldVehicle
    | ReleasePilotLatch
    | StartTimer
    | CancelTimer
    | Flight
)
