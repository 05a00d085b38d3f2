"""What the mission machine is told: operator's commands, facts of the world, finished steps, timers, a restart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from backend.commands import Command
from backend.events import AntennaFact, BearingMeasured, BeliefUpdated, CheckFact, PlanChosen, SweepRejected
from backend.mission.safety import Veto
from backend.spec import MissionSpec, Place

Link = Literal["vehicle", "receiver", "console", "payload"]
TimerName = Literal["console_hold", "console_return", "landing"]
StepName = Literal["take_off", "fly", "measure", "plan", "belief", "hold", "return", "land"]


@dataclass(frozen=True, slots=True)
class StartFacts:
    """What was true when the operator asked to start."""

    checks: tuple[CheckFact, ...]
    home: Place | None
    home_amsl_m: float | None
    software: str
    antenna: AntennaFact | None = None


@dataclass(frozen=True, slots=True)
class Commanded:
    """An operator's command. `objections`: vetoes found beforehand (safety of an override, a pilot who has not given
    control back when it is to be resumed, another mission flying, an area that cannot be searched from here).
    `on_ground`: the vehicle says that it stands on the ground. `failsafe_flies`: the autopilot is on its own way home,
    which this order may take it from."""

    command_id: str
    by: str
    command: Command
    objections: tuple[Veto, ...] = ()
    start: StartFacts | None = None
    on_ground: bool = False
    failsafe_flies: bool = False


@dataclass(frozen=True, slots=True)
class Edited:
    spec: MissionSpec


@dataclass(frozen=True, slots=True)
class PreflightDone:
    checks: tuple[CheckFact, ...]


@dataclass(frozen=True, slots=True)
class InTheAir:
    """Take-off finished."""

    place: Place
    altitude_relative_m: float


@dataclass(frozen=True, slots=True)
class Planned:
    """The planner chose. `vetoes`: what safety has against the choice."""

    choice: PlanChosen
    vetoes: tuple[Veto, ...] = ()


@dataclass(frozen=True, slots=True)
class NothingToPlan:
    """No place is left that may be flown to."""

    reason: str


@dataclass(frozen=True, slots=True)
class Arrived:
    place: Place
    distance_m: float
    flight_time_s: float


@dataclass(frozen=True, slots=True)
class SweepTaken:
    bearing: BearingMeasured


@dataclass(frozen=True, slots=True)
class SweepRefused:
    sweep: SweepRejected


@dataclass(frozen=True, slots=True)
class BeliefReady:
    """The belief folded from the bearings with these ids, in order."""

    bearing_ids: tuple[str, ...]
    fact: BeliefUpdated


@dataclass(frozen=True, slots=True)
class WorkFailed:
    """A step could not be done. `in_air`: what the vehicle's telemetry says (None: unknown, or on the ground and armed:
    it may still rise)."""

    step: StepName
    detail: str
    remedy: str
    in_air: bool | None


@dataclass(frozen=True, slots=True)
class WorkVetoed:
    """Safety refused a vehicle command right before it was sent."""

    vetoes: tuple[Veto, ...]


@dataclass(frozen=True, slots=True)
class PilotTookOver:
    """Somebody took control. perhaps_failsafe: the mode is one that the autopilot's failsafe enters by itself, too."""

    mode: str
    detail: str
    perhaps_failsafe: bool = False


@dataclass(frozen=True, slots=True)
class FailsafeActs:
    """Right after it was heard again, the vehicle begins the autopilot's own return or landing."""

    mode: str


@dataclass(frozen=True, slots=True)
class FailsafeStopped:
    """An order of ours that was under way when that began has stopped it. Nothing is sent: it might be a pilot."""

    mode: str


@dataclass(frozen=True, slots=True)
class LinkDown:
    link: Link
    detail: str


@dataclass(frozen=True, slots=True)
class LinkUp:
    """going_home: the vehicle is heard again in the autopilot's own return or landing, begun while it was not heard."""

    link: Link
    outage_s: float
    going_home: bool = False


@dataclass(frozen=True, slots=True)
class BatteryLow:
    """The battery just suffices for the way home and the reserve, or its charge is not known."""

    detail: str


@dataclass(frozen=True, slots=True)
class BatteryReported:
    """The charge is known again, and suffices."""


@dataclass(frozen=True, slots=True)
class HomeReached:
    """The returning vehicle is above its home."""


@dataclass(frozen=True, slots=True)
class Landed:
    """The vehicle says it is on the ground."""


@dataclass(frozen=True, slots=True)
class TimerExpired:
    name: TimerName


@dataclass(frozen=True, slots=True)
class NotStored:
    """Something of this mission can never be stored; it was kept aside."""

    detail: str


@dataclass(frozen=True, slots=True)
class Interrupted:
    """The server came back and cannot take this mission up again."""

    detail: str


@dataclass(frozen=True, slots=True)
class Restarted:
    """The server came back. `pilot`: the vehicle is in a mode that a pilot chose. `going_home`: in the autopilot's own
    return or landing, which its failsafe began while nobody commanded it; it is not interrupted."""

    pilot: bool
    going_home: bool
    detail: str


Input = (
    Commanded
    | Edited
    | PreflightDone
    | InTheAir
    | Planned
    | NothingToPlan
    | Arrived
    | SweepTaken
    | SweepRefused
    | BeliefReady
    | WorkFailed
    | WorkVetoed
    | PilotTookOver
    | FailsafeActs
    | FailsafeStopped
    | LinkDown
    | LinkUp
    | BatteryLow
    | BatteryReported
    | HomeReached
    | Landed
    | TimerExpired
    | NotStored
    | Interrupted
    | Restarted
)
