"""Why the vehicle did not do what it was asked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words

ManoeuvreName = Literal["take_off", "flight", "turn", "hold", "return", "landing"]
CommandName = Literal[
    "take_off_mode",
    "arming",
    "take_off",
    "steering_mode",
    "place",
    "speed",
    "spot",
    "turn",
    "hold",
    "return",
    "landing",
]
CommandResult = Literal[
    "accepted", "temporarily_rejected", "denied", "unsupported", "failed", "in_progress", "cancelled", "unknown"
]
"""MAV_RESULT."""

_MANOEUVRES = "take_off=take-off|flight=flight|turn=turn|hold=hold|return=return|landing=landing"
_MANOEUVRE = f"The {{manoeuvre?{_MANOEUVRES}}}"
_COMMANDS = (
    "take_off_mode=the mode for taking off|arming=arming|take_off=the take-off|steering_mode=the mode for steering"
    "|place=the next place|speed=the speed|spot=holding the spot|turn=the turn|hold=the hold|return=the return"
    "|landing=the landing"
)
_COMMAND = f"{{command?{_COMMANDS}}}"


@dataclass(frozen=True, slots=True)
class VehicleLinkNotOpened:
    """url: the vehicle's address; problem: the system's own words."""

    url: str
    problem: str
    code: Literal["vehicle_link_not_opened"] = "vehicle_link_not_opened"

    english: ClassVar[Words] = Words(
        "The vehicle link {url} cannot be opened: {problem}.",
        "Check that the device is there. Another ground station may be using the port.",
    )


@dataclass(frozen=True, slots=True)
class NoAutopilotAnswers:
    url: str
    waited_s: float
    code: Literal["no_autopilot_answers"] = "no_autopilot_answers"

    english: ClassVar[Words] = Words(
        "No autopilot answers on {url} within {waited_s}.",
        "Switch it on, and check that it sends to this address.",
    )


@dataclass(frozen=True, slots=True)
class HeartbeatStopped:
    url: str
    code: Literal["heartbeat_stopped"] = "heartbeat_stopped"

    english: ClassVar[Words] = Words(
        "An autopilot answered on {url}, but its heartbeat has stopped.", "Check its power and the link."
    )


@dataclass(frozen=True, slots=True)
class UnknownAutopilot:
    """number: MAV_AUTOPILOT."""

    url: str
    number: int
    code: Literal["unknown_autopilot"] = "unknown_autopilot"

    english: ClassVar[Words] = Words(
        "The autopilot on {url} is neither PX4 nor ArduPilot (MAV_AUTOPILOT {number}).",
        "Connect a vehicle with one of them.",
    )


@dataclass(frozen=True, slots=True)
class VehicleNotConnected:
    url: str
    code: Literal["vehicle_not_connected"] = "vehicle_not_connected"

    english: ClassVar[Words] = Words(
        "No vehicle is connected on {url}.", "Switch it on and check its link and its address."
    )


@dataclass(frozen=True, slots=True)
class VehicleSilent:
    """The manoeuvre was given up; the vehicle goes on with what it was commanded last."""

    manoeuvre: ManoeuvreName
    silent_s: float
    code: Literal["vehicle_silent"] = "vehicle_silent"

    english: ClassVar[Words] = Words(
        f"{_MANOEUVRE} was given up: nothing was heard from the vehicle for {{silent_s}}.", "Check the link."
    )


@dataclass(frozen=True, slots=True)
class PositionLost:
    """Before the first fix, or since."""

    code: Literal["position_lost"] = "position_lost"

    english: ClassVar[Words] = Words("The vehicle does not know its position.", "Wait for a GPS fix.")


@dataclass(frozen=True, slots=True)
class SticksMoved:
    manoeuvre: ManoeuvreName
    code: Literal["sticks_moved"] = "sticks_moved"

    english: ClassVar[Words] = Words(
        f"{_MANOEUVRE} is not possible: the pilot took over with the sticks.",
        "Resume when the pilot has given control back.",
    )


@dataclass(frozen=True, slots=True)
class ModeNotCommanded:
    """mode: as the autopilot names it. who flies since; nobody: it has landed."""

    manoeuvre: ManoeuvreName
    mode: str
    who: Literal["pilot", "failsafe", "nobody"]
    code: Literal["mode_not_commanded"] = "mode_not_commanded"

    english: ClassVar[Words] = Words(
        f"{_MANOEUVRE} is not possible: {{who?failsafe=the autopilot's failsafe|*=somebody else}} selected {{mode}}, "
        "which Crossfix did not command.",
        "{who?pilot=Resume when the pilot has given control back|failsafe=Hold or resume to take the vehicle from it"
        "|nobody=Resume or start to fly again}.",
    )


@dataclass(frozen=True, slots=True)
class ManoeuvreReplaced:
    manoeuvre: ManoeuvreName
    by: ManoeuvreName
    code: Literal["manoeuvre_replaced"] = "manoeuvre_replaced"

    english: ClassVar[Words] = Words(f"{_MANOEUVRE} was replaced by the {{by?{_MANOEUVRES}}}.")


@dataclass(frozen=True, slots=True)
class AutopilotRefused:
    """said: what the autopilot gave as its reason, in its own words; empty when it said nothing."""

    command: CommandName
    result: CommandResult
    said: str = ""
    code: Literal["autopilot_refused"] = "autopilot_refused"

    english: ClassVar[Words] = Words(
        f"The autopilot refused {_COMMAND}: "
        "{result?temporarily_rejected=temporarily rejected|in_progress=still in progress|denied=denied"
        "|unsupported=unsupported|failed=failed|cancelled=cancelled|*=for a reason that it does not give}."
        "{said?=|*= It says: “}{said}{said?=|*=”.}",
        "Read the autopilot's messages.",
    )


@dataclass(frozen=True, slots=True)
class PlaceNotTaken:
    """said: in the autopilot's own words; empty when it said nothing."""

    said: str
    code: Literal["place_not_taken"] = "place_not_taken"

    english: ClassVar[Words] = Words(
        "The autopilot does not fly to this place.{said?=|*= It says: “}{said}{said?=|*=”.}",
        "Look at the fence that it holds.",
    )


@dataclass(frozen=True, slots=True)
class CommandUnanswered:
    """attempts: how often it was sent."""

    command: CommandName
    attempts: int
    code: Literal["command_unanswered"] = "command_unanswered"

    english: ClassVar[Words] = Words(
        f"The autopilot did not answer {_COMMAND} (sent {{attempts|time|times}}).", "Check the link."
    )


@dataclass(frozen=True, slots=True)
class ModeNotShown:
    """attempts: how often the autopilot acknowledged it."""

    command: CommandName
    attempts: int
    code: Literal["mode_not_shown"] = "mode_not_shown"

    english: ClassVar[Words] = Words(
        f"The autopilot acknowledged {_COMMAND} ({{attempts|time|times}}), but its mode never showed it.",
        "Read the autopilot's messages.",
    )


@dataclass(frozen=True, slots=True)
class ModeLeft:
    """Nothing was sent. The vehicle is no longer in the mode in which it obeys the command, and nobody took it."""

    command: CommandName
    code: Literal["mode_left"] = "mode_left"

    english: ClassVar[Words] = Words(
        f"The vehicle has left the mode in which it obeys {_COMMAND}.", "Read the autopilot's messages."
    )


@dataclass(frozen=True, slots=True)
class NotInTheAir:
    code: Literal["not_in_the_air"] = "not_in_the_air"

    english: ClassVar[Words] = Words("The vehicle is not in the air.", "Take off first.")


@dataclass(frozen=True, slots=True)
class StandsDisarmed:
    """manoeuvre: the one that has nothing to do there."""

    manoeuvre: Literal["return", "landing"]
    code: Literal["stands_disarmed"] = "stands_disarmed"

    english: ClassVar[Words] = Words(
        "The vehicle stands disarmed on the ground: there is nothing to {manoeuvre?return=return from|landing=land}."
    )


@dataclass(frozen=True, slots=True)
class TakeOffIgnored:
    code: Literal["take_off_ignored"] = "take_off_ignored"

    english: ClassVar[Words] = Words(
        "The autopilot acknowledged the take-off, but the vehicle stayed on the ground.",
        "Read the autopilot's messages.",
    )


@dataclass(frozen=True, slots=True)
class NoTakeOff:
    waited_s: float
    because: AutopilotRefused | CommandUnanswered | TakeOffIgnored
    code: Literal["no_take_off"] = "no_take_off"

    english: ClassVar[Words] = Words("No take-off within {waited_s}. {because}", "{because!remedy}")


@dataclass(frozen=True, slots=True)
class ClimbTooLow:
    """reached_m, wanted_m: above home."""

    reached_m: float
    wanted_m: float
    code: Literal["climb_too_low"] = "climb_too_low"

    english: ClassVar[Words] = Words(
        "The vehicle climbed to {reached_m:1} only, not to {wanted_m:1}.",
        "Look for an altitude limit of the autopilot.",
    )


@dataclass(frozen=True, slots=True)
class NoProgress:
    """For `waited_s` the vehicle came no nearer to its place."""

    waited_s: float
    distance_m: float
    code: Literal["no_progress"] = "no_progress"

    english: ClassVar[Words] = Words("No progress for {waited_s} with {distance_m} to go.", "Check the wind.")


@dataclass(frozen=True, slots=True)
class NotArrived:
    """distance_m: still to go over ground; climb_m: up or down."""

    distance_m: float
    climb_m: float
    code: Literal["not_arrived"] = "not_arrived"

    english: ClassVar[Words] = Words(
        "The vehicle did not arrive: it is still {distance_m:1} away and {climb_m:1} too high or too low.",
        "Check the wind and the autopilot's messages.",
    )


@dataclass(frozen=True, slots=True)
class TurnStopped:
    """turned_deg: as far as telemetry showed."""

    turned_deg: float
    code: Literal["turn_stopped"] = "turn_stopped"

    english: ClassVar[Words] = Words("The turn stopped after {turned_deg}.")


@dataclass(frozen=True, slots=True)
class TurnNotMade:
    """ways: of turning that were tried."""

    turned_deg: float
    ways: int
    code: Literal["turn_not_made"] = "turn_not_made"

    english: ClassVar[Words] = Words(
        "The vehicle acknowledged the turn but did not make it: {turned_deg} seen, {ways|way|ways} tried.",
        "Check the wind and the autopilot's messages.",
    )


@dataclass(frozen=True, slots=True)
class HoldIgnored:
    code: Literal["hold_ignored"] = "hold_ignored"

    english: ClassVar[Words] = Words("The autopilot acknowledged the hold, but the vehicle does not hover.")


@dataclass(frozen=True, slots=True)
class DoesNotHold:
    because: AutopilotRefused | HoldIgnored
    code: Literal["does_not_hold"] = "does_not_hold"

    english: ClassVar[Words] = Words("{because}", "The pilot should take over.")


@dataclass(frozen=True, slots=True)
class ParameterNotSet:
    parameter: str
    wanted: float
    code: Literal["parameter_not_set"] = "parameter_not_set"

    english: ClassVar[Words] = Words(
        "The autopilot did not take {parameter} = {wanted}.", "Set it with its own ground station."
    )


VehicleReason = (
    VehicleLinkNotOpened
    | NoAutopilotAnswers
    | HeartbeatStopped
    | UnknownAutopilot
    | VehicleNotConnected
    | VehicleSilent
    | PositionLost
    | SticksMoved
    | ModeNotCommanded
    | ManoeuvreReplaced
    | AutopilotRefused
    | PlaceNotTaken
    | CommandUnanswered
    | ModeNotShown
    | ModeLeft
    | NotInTheAir
    | StandsDisarmed
    | TakeOffIgnored
    | NoTakeOff
    | ClimbTooLow
    | NoProgress
    | NotArrived
    | TurnStopped
    | TurnNotMade
    | HoldIgnored
    | DoesNotHold
    | ParameterNotSet
)
