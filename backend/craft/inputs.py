"""What happens to a craft: an operator's orders, facts of the world, finished work, timers, a restart."""

from __future__ import annotations

from dataclasses import dataclass

from backend.commands import ForCraft
from backend.craft.effects import TimerName
from backend.craft.safety import BatteryStage
from backend.events import (
    AntennaFact,
    BearingMeasured,
    CheckFact,
    GroundFact,
    HeardOnTheWay,
    Link,
    PlanChosen,
    SweepRejected,
)
from backend.reasons import Reason
from backend.reasons.flight import OtherAntenna, StepName, WatchBroke, Way
from backend.spec import LearnedErrors, Place
from hardware.authority import Authority
from hardware.reasons.receiver import SamplesLost
from hardware.reasons.vehicle_news import AutopilotWords, ClockRateOdd


@dataclass(frozen=True, slots=True)
class StartFacts:
    """What was true when the operator asked to start."""

    checks: tuple[CheckFact, ...]
    home: Place | None
    home_amsl_m: float | None
    software: str
    antenna: AntennaFact | None = None
    ground: GroundFact | None = None
    learned: LearnedErrors | None = None


@dataclass(frozen=True, slots=True)
class Foretold:
    """What the operator was told of a place before choosing it: seconds until localized by way of it."""

    mean_s: float
    p90_s: float | None
    rollouts: int


@dataclass(frozen=True, slots=True)
class CraftOrdered:
    """An operator's command. objections: vetoes found beforehand (safety of an override, a pilot who has not given
    control back when it is to be resumed, another mission flying). on_ground: the vehicle says that it stands
    there. altitude_amsl_m: at which an override would be flown to; foretold: what was said of its place before."""

    by: str
    command: ForCraft
    objections: tuple[Reason, ...] = ()
    start: StartFacts | None = None
    on_ground: bool = False
    altitude_amsl_m: float | None = None
    foretold: Foretold | None = None


@dataclass(frozen=True, slots=True)
class SearchChanged:
    """The search knows more, or something else, than a moment ago: a belief is ready, a bearing came or went."""


@dataclass(frozen=True, slots=True)
class InTheAir:
    """Take-off finished."""

    place: Place
    altitude_relative_m: float


@dataclass(frozen=True, slots=True)
class Planned:
    """The planner chose. vetoes: what safety has against the choice."""

    choice: PlanChosen
    vetoes: tuple[Reason, ...] = ()


@dataclass(frozen=True, slots=True)
class NothingToPlan:
    """No place is left that may be flown to."""

    because: Reason


@dataclass(frozen=True, slots=True)
class Arrived:
    """distance_m: how far from where it was sent to. flight_time_s: by the mission's clock. heard: on the way."""

    place: Place
    distance_m: float
    flight_time_s: float
    heard: tuple[HeardOnTheWay, ...] = ()


@dataclass(frozen=True, slots=True)
class SweepTaken:
    """One turn: what it said of each emitter."""

    results: tuple[BearingMeasured | SweepRejected, ...]


@dataclass(frozen=True, slots=True)
class CarriedOut:
    """Telemetry shows that the vehicle does what it was told."""

    way: Way


@dataclass(frozen=True, slots=True)
class WorkFailed:
    """A piece of work could not be done. in_air: what the vehicle's telemetry says (None: unknown, or on the ground and
    armed: it may still rise)."""

    step: StepName
    because: Reason
    in_air: bool | None


@dataclass(frozen=True, slots=True)
class PlaceNotTaken:
    """The autopilot will not fly to this place; the vehicle hovers where it is."""

    place: Place
    because: Reason


@dataclass(frozen=True, slots=True)
class Said:
    """The autopilot warns of something, in its own words."""

    reason: AutopilotWords


@dataclass(frozen=True, slots=True)
class SaidNoMore:
    """This text was not heard for a long time."""

    text: str


@dataclass(frozen=True, slots=True)
class ClockOdd:
    """The autopilot's clock runs at another rate than ours: its headings cannot be dated."""

    because: ClockRateOdd


@dataclass(frozen=True, slots=True)
class ClockAgrees:
    """The two clocks run at one rate again."""


@dataclass(frozen=True, slots=True)
class ReceiverLoses:
    """A good part of its samples, and goes on."""

    because: SamplesLost


@dataclass(frozen=True, slots=True)
class ReceiverKeepsUp:
    """It loses none any more that would matter."""


@dataclass(frozen=True, slots=True)
class WorkVetoed:
    """Safety refused a vehicle command right before it was sent. on_ground: a take-off, and it stands there still."""

    vetoes: tuple[Reason, ...]
    on_ground: bool = False


@dataclass(frozen=True, slots=True)
class AuthorityHeard:
    """Who flies, as the vehicle link judges it now."""

    authority: Authority


@dataclass(frozen=True, slots=True)
class FailsafeEnded:
    """The autopilot's own way home ended in a mode of waiting, perhaps by an earlier order. Nothing is sent: it might
    be a pilot."""

    mode: str


@dataclass(frozen=True, slots=True)
class LinkDown:
    """because: what was lost, as the alert will say it."""

    link: Link
    because: Reason


@dataclass(frozen=True, slots=True)
class LinkUp:
    """outage_s: how long nothing came over it."""

    link: Link
    outage_s: float


@dataclass(frozen=True, slots=True)
class BatteryLow:
    """The battery just suffices for the way home and the reserve, or its charge is not known. stage: how low it is."""

    because: Reason
    stage: BatteryStage = "return"


@dataclass(frozen=True, slots=True)
class ChargeLow:
    """The battery runs low, and nobody has worked out what the way home takes: an alert, and nothing is ordered."""

    because: Reason


@dataclass(frozen=True, slots=True)
class BatteryReported:
    """The charge is known again, and suffices."""


@dataclass(frozen=True, slots=True)
class AutopilotReturns:
    """The autopilot's own return was ordered: ours cannot be flown."""

    because: Reason


@dataclass(frozen=True, slots=True)
class HomeReached:
    """The returning vehicle is above its home."""


@dataclass(frozen=True, slots=True)
class Landed:
    """The vehicle says it is on the ground."""


@dataclass(frozen=True, slots=True)
class TimerExpired:
    """A timer that was cancelled does not expire any more."""

    name: TimerName


@dataclass(frozen=True, slots=True)
class Broke:
    """A background task of ours failed."""

    because: WatchBroke


@dataclass(frozen=True, slots=True)
class NetsUp:
    """The autopilot has the nets of the area that is searched now."""


@dataclass(frozen=True, slots=True)
class NetsNotTaken:
    """It has not, and is given them again."""

    because: Reason


@dataclass(frozen=True, slots=True)
class Restarted:
    """The server came back, and this is who flies now. on_ground: the vehicle says that it stands there, disarmed.
    other_antenna: that the server was given another one than the craft has flown with."""

    authority: Authority
    on_ground: bool = False
    other_antenna: OtherAntenna | None = None


@dataclass(frozen=True, slots=True)
class Leaving:
    """This server is about to end; nobody is there to fly on. homeward: the autopilot returns or lands by itself."""

    homeward: bool = False


@dataclass(frozen=True, slots=True)
class Abandoned:
    """Nobody brings this flight back after a restart: another one took its place, or it cannot be read."""

    because: Reason


CraftInput = (
    CraftOrdered
    | SearchChanged
    | InTheAir
    | Planned
    | NothingToPlan
    | Arrived
    | SweepTaken
    | CarriedOut
    | WorkFailed
    | PlaceNotTaken
    | Said
    | SaidNoMore
    | ClockOdd
    | ClockAgrees
    | ReceiverLoses
    | ReceiverKeepsUp
    | WorkVetoed
    | AuthorityHeard
    | FailsafeEnded
    | LinkDown
    | LinkUp
    | BatteryLow
    | ChargeLow
    | BatteryReported
    | AutopilotReturns
    | HomeReached
    | Landed
    | TimerExpired
    | Broke
    | NetsUp
    | NetsNotTaken
    | Restarted
    | Leaving
    | Abandoned
)
