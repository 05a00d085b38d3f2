"""What the vehicle link announces: something changed, or a command had to be repeated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from hardware.reasons.vehicle import (
    AutopilotRefused,
    CommandUnanswered,
    HoldIgnored,
    ModeNotShown,
    NoProgress,
    TakeOffIgnored,
    TurnStopped,
)
from planner.reason import Words


@dataclass(frozen=True, slots=True)
class VehicleConnected:
    autopilot: Literal["px4", "ardupilot"]
    url: str
    code: Literal["vehicle_connected"] = "vehicle_connected"

    english: ClassVar[Words] = Words("Connected to {autopilot?px4=PX4|ardupilot=ArduPilot} on {url}.")


@dataclass(frozen=True, slots=True)
class VehicleUnheard:
    code: Literal["vehicle_unheard"] = "vehicle_unheard"

    english: ClassVar[Words] = Words(
        "The vehicle link is lost.", "Check radio, cable and vehicle address; the autopilot's failsafe acts meanwhile."
    )


@dataclass(frozen=True, slots=True)
class VehicleHeardAgain:
    outage_s: float
    code: Literal["vehicle_heard_again"] = "vehicle_heard_again"

    english: ClassVar[Words] = Words("The vehicle link is restored after {outage_s:1}.")


@dataclass(frozen=True, slots=True)
class AutopilotRestarted:
    code: Literal["autopilot_restarted"] = "autopilot_restarted"

    english: ClassVar[Words] = Words("The autopilot has restarted.")


Worse = Literal["critical", "error", "warning"]


@dataclass(frozen=True, slots=True)
class AutopilotSaid:
    """text: the autopilot's own words, made printable."""

    severity: Worse
    text: str
    code: Literal["autopilot_said"] = "autopilot_said"

    english: ClassVar[Words] = Words("The autopilot says: “{text}”.")


@dataclass(frozen=True, slots=True)
class AutopilotRepeats:
    """times: heard so often since the first."""

    severity: Worse
    text: str
    times: int
    code: Literal["autopilot_repeats"] = "autopilot_repeats"

    english: ClassVar[Words] = Words("The autopilot says again: “{text}” ({times|time|times}).")


@dataclass(frozen=True, slots=True)
class AutopilotSaidMore:
    """texts: different ones, that came too fast to be shown one by one."""

    texts: int
    code: Literal["autopilot_said_more"] = "autopilot_said_more"

    english: ClassVar[Words] = Words(
        "The autopilot said {texts|more thing|more things} than can be shown.", "Read them in the server's log."
    )


AutopilotWords = AutopilotSaid | AutopilotRepeats | AutopilotSaidMore


@dataclass(frozen=True, slots=True)
class ClockRateOdd:
    """rate: seconds of the autopilot's clock in one of ours."""

    rate: float
    code: Literal["clock_rate_odd"] = "clock_rate_odd"

    english: ClassVar[Words] = Words(
        "The autopilot's clock runs at {rate:2} of ours: its headings cannot be dated.",
        "Restart the autopilot. A simulator needs more processor.",
    )


@dataclass(frozen=True, slots=True)
class ModeChanged:
    """mode: as the autopilot names it."""

    mode: str
    code: Literal["mode_changed"] = "mode_changed"

    english: ClassVar[Words] = Words("The vehicle is in {mode}.")


@dataclass(frozen=True, slots=True)
class PositionJumped:
    """jumped_m: from where the vehicle could have flown."""

    jumped_m: float
    code: Literal["position_jumped"] = "position_jumped"

    english: ClassVar[Words] = Words("The GPS position jumped by {jumped_m}.")


@dataclass(frozen=True, slots=True)
class TakenOver:
    """mode: the one that they selected, as the autopilot names it."""

    who: Literal["pilot", "failsafe"]
    mode: str
    code: Literal["taken_over"] = "taken_over"

    english: ClassVar[Words] = Words("The {who?pilot=pilot|failsafe=autopilot's failsafe} took over in {mode}.")


@dataclass(frozen=True, slots=True)
class TakenOverBySticks:
    code: Literal["taken_over_by_sticks"] = "taken_over_by_sticks"

    english: ClassVar[Words] = Words("The pilot took over with the sticks.")


@dataclass(frozen=True, slots=True)
class SwitchUndone:
    """mode: the one the vehicle is in."""

    mode: str
    code: Literal["switch_undone"] = "switch_undone"

    english: ClassVar[Words] = Words(
        "An order that was under way undid the pilot's switch: the vehicle is in {mode}. Nothing more is sent.",
        "The pilot selects the mode again.",
    )


@dataclass(frozen=True, slots=True)
class OperatorInControl:
    code: Literal["operator_in_control"] = "operator_in_control"

    english: ClassVar[Words] = Words("The operator took control.")


@dataclass(frozen=True, slots=True)
class StillMoving:
    """The vehicle obeys the hold and does not come to rest."""

    speed_m_s: float
    code: Literal["still_moving"] = "still_moving"

    english: ClassVar[Words] = Words("The vehicle holds, but it still moves at {speed_m_s:1}.", "Look at the wind.")


@dataclass(frozen=True, slots=True)
class ParameterSet:
    parameter: str
    before: float
    after: int
    code: Literal["parameter_set"] = "parameter_set"

    english: ClassVar[Words] = Words("{parameter} was set from {before} to {after}.")


@dataclass(frozen=True, slots=True)
class TriedAgain:
    """attempt: the number of the one that follows, the first is 1."""

    because: (
        AutopilotRefused | CommandUnanswered | ModeNotShown | HoldIgnored | NoProgress | TurnStopped | TakeOffIgnored
    )
    attempt: int
    code: Literal["tried_again"] = "tried_again"

    english: ClassVar[Words] = Words("{because} Attempt {attempt} follows.")


VehicleNews = (
    VehicleConnected
    | VehicleUnheard
    | VehicleHeardAgain
    | AutopilotRestarted
    | ClockRateOdd
    | AutopilotWords
    | ModeChanged
    | PositionJumped
    | TakenOver
    | TakenOverBySticks
    | SwitchUndone
    | OperatorInControl
    | StillMoving
    | ParameterSet
    | TriedAgain
)
