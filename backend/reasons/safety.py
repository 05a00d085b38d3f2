"""What safety has against a start, a place or a command: the vetoes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words

What = Literal["vehicle_stands", "vehicle", "home", "place"]
_WHAT = "{what?vehicle_stands=The vehicle stands|vehicle=The vehicle is|home=Home is|place=The place is}"


Over = Literal["way_there", "way_home", "take_off"]
_OVER = "{where?way_there=The way there|way_home=The way home from there|take_off=The take-off}"


@dataclass(frozen=True, slots=True)
class FailsafeActs:
    mode: str
    code: Literal["failsafe_acts"] = "failsafe_acts"
    english: ClassVar[Words] = Words("The autopilot acts by itself: {mode}.", "Hold or resume first.")


@dataclass(frozen=True, slots=True)
class PilotControls:
    code: Literal["pilot_controls"] = "pilot_controls"
    english: ClassVar[Words] = Words(
        "The pilot has control: nothing is sent to the vehicle.", "Resume when the pilot has given control back."
    )


@dataclass(frozen=True, slots=True)
class NotGivenBack:
    """mode: the pilot's, in which the vehicle still is."""

    mode: str
    code: Literal["not_given_back"] = "not_given_back"
    english: ClassVar[Words] = Words(
        "The pilot has not given control back: the vehicle is still in {mode}.",
        "The pilot selects HOLD (PX4) or BRAKE or GUIDED (ArduPilot) on the transmitter, then resume.",
    )


@dataclass(frozen=True, slots=True)
class NoLink:
    code: Literal["no_link"] = "no_link"
    english: ClassVar[Words] = Words(
        "The link to the vehicle is lost.", "Wait until the vehicle answers again; its own failsafe acts meanwhile."
    )


@dataclass(frozen=True, slots=True)
class NoPosition:
    code: Literal["no_position"] = "no_position"
    english: ClassVar[Words] = Words("The vehicle has no position.", "Wait for a GPS fix.")


@dataclass(frozen=True, slots=True)
class PositionOld:
    age_s: float
    code: Literal["position_old"] = "position_old"
    english: ClassVar[Words] = Words("The vehicle's position is {age_s:1} old.", "Wait until telemetry arrives again.")


@dataclass(frozen=True, slots=True)
class BatteryUnknown:
    code: Literal["battery_unknown"] = "battery_unknown"
    english: ClassVar[Words] = Words(
        "The vehicle does not report its battery.",
        "Set up the battery monitor, or say in the mission that this vehicle reports no battery.",
    )


@dataclass(frozen=True, slots=True)
class BatterySilent:
    code: Literal["battery_silent"] = "battery_silent"
    english: ClassVar[Words] = Words("The battery's charge is no longer reported.", "Check the battery monitor.")


@dataclass(frozen=True, slots=True)
class BatteryShort:
    """left_percent: when the way home begins; needed_percent: for the way home; reserve_percent: of the mission."""

    charge_percent: float
    left_percent: float
    needed_percent: float
    reserve_percent: float
    code: Literal["battery_short"] = "battery_short"
    english: ClassVar[Words] = Words(
        "Battery at {charge_percent}: the way home would begin at {left_percent} and takes {needed_percent}; "
        "the reserve is {reserve_percent}.",
        "Return home and change the battery.",
    )


@dataclass(frozen=True, slots=True)
class TurnBeyondBattery:
    """turn_s: of one turn, with all its rounds. takes_percent: for it; needed_percent: for the way home."""

    turn_s: float
    takes_percent: float
    needed_percent: float
    reserve_percent: float
    code: Literal["turn_beyond_battery"] = "turn_beyond_battery"
    english: ClassVar[Words] = Words(
        "A turn takes {turn_s}, for which {takes_percent} of a battery is set aside as long as wind and craft are not "
        "known. With {needed_percent} for the way home and a reserve of {reserve_percent} no battery is full enough.",
        "Look for fewer emitters or for a signal that is sent more often, or lower the reserve of a craft that stays "
        "up for long.",
    )


@dataclass(frozen=True, slots=True)
class FirstTurnBeyondCharge:
    """far_m: the way to the first place; takes_percent: the climb, that way and a turn; needed_percent: the way home.
    A full battery would do."""

    charge_percent: float
    far_m: float
    takes_percent: float
    needed_percent: float
    reserve_percent: float
    code: Literal["first_turn_beyond_charge"] = "first_turn_beyond_charge"
    english: ClassVar[Words] = Words(
        "Battery at {charge_percent}: the craft would come home before its first turn, {far_m} away. To get there and "
        "turn {takes_percent} is set aside, {needed_percent} for the way home, and the reserve is {reserve_percent}.",
        "Charge or change the battery, take off nearer to the area, or draw one that is nearer.",
    )


@dataclass(frozen=True, slots=True)
class FirstTurnBeyondBattery:
    """As `FirstTurnBeyondCharge`, and a full battery would not do."""

    charge_percent: float
    far_m: float
    takes_percent: float
    needed_percent: float
    reserve_percent: float
    code: Literal["first_turn_beyond_battery"] = "first_turn_beyond_battery"
    english: ClassVar[Words] = Words(
        "The craft would come home before its first turn, {far_m} away: to get there and turn {takes_percent} is set "
        "aside as long as wind and craft are not known, {needed_percent} for the way home, and the reserve is "
        "{reserve_percent}. No battery is full enough.",
        "Take off nearer to the area, draw one that is nearer, or lower the reserve of a craft that stays up for long.",
    )


@dataclass(frozen=True, slots=True)
class AltitudeOutside:
    """All relative to home."""

    altitude_relative_m: float
    lowest_relative_m: float
    highest_relative_m: float
    code: Literal["altitude_outside"] = "altitude_outside"
    english: ClassVar[Words] = Words(
        "{altitude_relative_m} above home is outside the allowed {lowest_relative_m} to {highest_relative_m}.",
        "Change the mission's altitude or its band.",
    )


@dataclass(frozen=True, slots=True)
class TooFarFromHome:
    distance_m: float
    most_m: float
    code: Literal["too_far_from_home"] = "too_far_from_home"
    english: ClassVar[Words] = Words(
        "The place is {distance_m} from home, more than {most_m}.", "Choose a place nearer to home."
    )


@dataclass(frozen=True, slots=True)
class AlreadyInAir:
    code: Literal["already_in_air"] = "already_in_air"
    english: ClassVar[Words] = Words("The vehicle is already in the air.", "Land it; a mission starts on the ground.")


@dataclass(frozen=True, slots=True)
class OutsideFence:
    what: What
    beyond_m: float
    code: Literal["outside_fence"] = "outside_fence"
    english: ClassVar[Words] = Words(
        _WHAT + " {beyond_m} outside the fence.",
        "{what?place=Choose a place inside, or widen the fence.|*=Draw the fence around the vehicle and its home.}",
    )


@dataclass(frozen=True, slots=True)
class InsideNoFly:
    what: What
    code: Literal["inside_no_fly"] = "inside_no_fly"
    english: ClassVar[Words] = Words(
        _WHAT + " inside a no-fly zone.",
        "{what?place=Choose a place outside the zone.|*=Draw the no-fly zones beside the vehicle and its home.}",
    )


@dataclass(frozen=True, slots=True)
class NearNoFly:
    near_m: float
    least_m: float
    code: Literal["near_no_fly"] = "near_no_fly"
    english: ClassVar[Words] = Words(
        "The place is {near_m:1} from a no-fly zone, and a hovering vehicle wanders.",
        "Choose a place {least_m} or more from the zone.",
    )


@dataclass(frozen=True, slots=True)
class WayLeavesFence:
    code: Literal["way_leaves_fence"] = "way_leaves_fence"
    english: ClassVar[Words] = Words("The way there leaves the fence.", "Fly by way of a place in between.")


@dataclass(frozen=True, slots=True)
class WayCrossesNoFly:
    code: Literal["way_crosses_no_fly"] = "way_crosses_no_fly"
    english: ClassVar[Words] = Words("The way there crosses a no-fly zone.", "Fly by way of a place beside the zone.")


@dataclass(frozen=True, slots=True)
class NoWayHome:
    """distance_m: to home, as the crow flies."""

    distance_m: float
    code: Literal["no_way_home"] = "no_way_home"
    english: ClassVar[Words] = Words(
        "From where the vehicle is no way around the no-fly zones and inside the fence leads home, {distance_m} away.",
        "Draw the fence and the no-fly zones so that there is one.",
    )


@dataclass(frozen=True, slots=True)
class GroundUnknown:
    """where: the way to the place, or from there home."""

    where: Over
    code: Literal["ground_unknown"] = "ground_unknown"
    english: ClassVar[Words] = Words(
        _OVER + " leads over ground whose height the terrain does not know.",
        "Upload terrain for the whole fence, or remove the terrain: the ground then counts as level with home.",
    )


@dataclass(frozen=True, slots=True)
class ClearanceShort:
    """clearance_m: what would be left above the highest ground within tolerance."""

    where: Over
    altitude_relative_m: float
    clearance_m: float
    least_m: float
    code: Literal["clearance_short"] = "clearance_short"
    english: ClassVar[Words] = Words(
        _OVER
        + " at {altitude_relative_m} above home is only {clearance_m:1} above the ground; {least_m:1} are needed.",
        "Choose another place, or allow more altitude above home.",
    )


@dataclass(frozen=True, slots=True)
class TooHighAboveGround:
    """height_m: above the lowest ground within tolerance."""

    where: Over
    altitude_relative_m: float
    height_m: float
    most_m: float
    code: Literal["too_high_above_ground"] = "too_high_above_ground"
    english: ClassVar[Words] = Words(
        _OVER + " at {altitude_relative_m} above home is {height_m:1} above the ground; {most_m:1} are allowed.",
        "Choose a nearer place: the ground falls away below one level way.",
    )


BATTERY = (BatteryUnknown, BatterySilent, BatteryShort)
"""Vetoes for which the answer is to go home."""
GROUND = (GroundUnknown, ClearanceShort, TooHighAboveGround, AltitudeOutside)
"""Vetoes of the height above ground or home: another place may do."""

SafetyReason = (
    FailsafeActs
    | PilotControls
    | NotGivenBack
    | NoLink
    | NoPosition
    | PositionOld
    | BatteryUnknown
    | BatterySilent
    | BatteryShort
    | TurnBeyondBattery
    | FirstTurnBeyondCharge
    | FirstTurnBeyondBattery
    | AltitudeOutside
    | TooFarFromHome
    | AlreadyInAir
    | OutsideFence
    | InsideNoFly
    | NearNoFly
    | WayLeavesFence
    | WayCrossesNoFly
    | NoWayHome
    | GroundUnknown
    | ClearanceShort
    | TooHighAboveGround
)
