"""What the checklist says of a line that is fine, or of equipment that is not ready."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class RoomToFly:
    area_m2: float
    code: Literal["room_to_fly"] = "room_to_fly"
    english: ClassVar[Words] = Words("There are {area_m2} to fly in.")


@dataclass(frozen=True, slots=True)
class StartAllowed:
    code: Literal["start_allowed"] = "start_allowed"
    english: ClassVar[Words] = Words("Fence, battery and position allow the start.")


@dataclass(frozen=True, slots=True)
class ReceiverDelivers:
    channels: int
    code: Literal["receiver_delivers"] = "receiver_delivers"
    english: ClassVar[Words] = Words("The receiver delivers samples on {channels|channel|channels}.")


@dataclass(frozen=True, slots=True)
class ReceiverTakesTurns:
    """rounds: whole turns, one for each group of channels that its band holds. turn_s: of all of them."""

    channels: int
    rounds: int
    turn_s: float
    code: Literal["receiver_takes_turns"] = "receiver_takes_turns"
    english: ClassVar[Words] = Words(
        "The receiver works. Its band holds the {channels} channels in {rounds} groups, one after another: the craft "
        "goes round once for each, which takes {turn_s} at every place, and less once emitters are found."
    )


@dataclass(frozen=True, slots=True)
class TurnTakesLong:
    turn_s: float
    code: Literal["turn_takes_long"] = "turn_takes_long"
    english: ClassVar[Words] = Words(
        "The receiver works. The pulses come so seldom that a turn takes up to {turn_s} at every place.",
        "Where they come every few seconds, fewer of them a heading make it shorter; see that the battery lasts for "
        "two turns.",
    )


@dataclass(frozen=True, slots=True)
class FewTurnsOnABattery:
    """turns: of turn_s each, that a full battery is not taken to last for, with the ways and the reserve."""

    turns: int
    turn_s: float
    code: Literal["few_turns_on_a_battery"] = "few_turns_on_a_battery"
    english: ClassVar[Words] = Words(
        "A turn takes {turn_s}. As long as wind and craft are not known, not even a full battery is sure to last for "
        "{turns} of them in the middle of the area, and no search does with fewer.",
        "Look for fewer emitters or for a signal that is sent more often, or lower the reserve of a craft that stays "
        "up for long.",
    )


@dataclass(frozen=True, slots=True)
class FewTurnsOnThisCharge:
    """turns: of turn_s each, that a full battery is taken to last for and this charge is not."""

    charge_percent: float
    turns: int
    turn_s: float
    code: Literal["few_turns_on_this_charge"] = "few_turns_on_this_charge"
    english: ClassVar[Words] = Words(
        "At {charge_percent} the battery may not last for {turns|turn|turns} of {turn_s}, the ways to the far end of "
        "the area and home, and the reserve. No search takes fewer turns.",
        "Change the battery, or expect the craft to come home before it has found anything.",
    )


@dataclass(frozen=True, slots=True)
class FirstTurnInLittleWind:
    """far_m: the way to the first place, which the battery is taken to last for unless it is windy."""

    charge_percent: float
    far_m: float
    code: Literal["first_turn_in_little_wind"] = "first_turn_in_little_wind"
    english: ClassVar[Words] = Words(
        "If it is windy, the battery, at {charge_percent}, may not last for the first turn, {far_m} away, and the way "
        "home.",
        "Take off nearer to the area or with a fuller battery, or expect the craft to come home before it has turned.",
    )


@dataclass(frozen=True, slots=True)
class NoSamples:
    code: Literal["no_samples"] = "no_samples"
    english: ClassVar[Words] = Words(
        "The receiver delivers no samples.", "Check that it is plugged in and not in use by another program."
    )


@dataclass(frozen=True, slots=True)
class TagUnheard:
    frequency_hz: float
    code: Literal["tag_unheard"] = "tag_unheard"
    english: ClassVar[Words] = Words(
        "The receiver works, but hears no pulse of the tag at {frequency_hz}.",
        "Bring the tag nearer, or accept that it is out of range here.",
    )


@dataclass(frozen=True, slots=True)
class PatternInUse:
    name: str
    code: Literal["pattern_in_use"] = "pattern_in_use"
    english: ClassVar[Words] = Words("The antenna pattern is {name}.")


@dataclass(frozen=True, slots=True)
class NoVehicleYet:
    """address: where it is looked for."""

    address: str
    code: Literal["no_vehicle_yet"] = "no_vehicle_yet"
    english: ClassVar[Words] = Words(
        "No vehicle has answered on {address} yet.", "Switch it on and check its link and address."
    )


@dataclass(frozen=True, slots=True)
class ConnectingBroke:
    """A fault of ours; the log has the traceback."""

    address: str
    code: Literal["connecting_broke"] = "connecting_broke"
    english: ClassVar[Words] = Words("Connecting to {address} failed inside Crossfix and is tried again.")


_RETURN = (
    "Set {parameter} so that the autopilot's own return stays at or below the mission's ceiling of {ceiling_relative_m}"
)


@dataclass(frozen=True, slots=True)
class ReturnAltitudeChecked:
    """Relative to home. altitude_relative_m: what the autopilot's own return climbs to, 0 when it does not climb."""

    parameter: str
    altitude_relative_m: float
    ceiling_relative_m: float
    code: Literal["return_altitude_checked"] = "return_altitude_checked"
    english: ClassVar[Words] = Words(
        "The autopilot's own return climbs to {altitude_relative_m} ({parameter}).", _RETURN + ", or raise that."
    )


@dataclass(frozen=True, slots=True)
class ReturnMeetsGround:
    """Relative to home. least_relative_m: as high it must climb to keep its clearance on a straight way home."""

    parameter: str
    altitude_relative_m: float
    least_relative_m: float
    code: Literal["return_meets_ground"] = "return_meets_ground"
    english: ClassVar[Words] = Words(
        "The autopilot's own return climbs to {altitude_relative_m} ({parameter}) and flies straight home: over the "
        "ground in between it needs {least_relative_m}.",
        "Set {parameter} to at least {least_relative_m}, and the mission's ceiling no lower; or choose another home.",
    )


@dataclass(frozen=True, slots=True)
class ReturnClimbs:
    """Relative to home. from_relative_m: the highest that the mission flies."""

    parameter: str
    climb_m: float
    from_relative_m: float
    ceiling_relative_m: float
    code: Literal["return_climbs"] = "return_climbs"
    english: ClassVar[Words] = Words(
        "The autopilot's own return climbs by {climb_m} from however high it begins ({parameter}): from "
        "{from_relative_m} that leads above the mission's ceiling of {ceiling_relative_m}.",
        "Set {parameter} to 0, or raise the mission's ceiling.",
    )


@dataclass(frozen=True, slots=True)
class ReturnAltitudeUnread:
    parameter: str
    ceiling_relative_m: float
    code: Literal["return_altitude_unread"] = "return_altitude_unread"
    english: ClassVar[Words] = Words(
        "How high the autopilot's own return climbs ({parameter}) could not be read.", _RETURN + "."
    )


@dataclass(frozen=True, slots=True)
class HomeMovesHere:
    """away_m: from where the vehicle stands to the home that its autopilot tells of."""

    away_m: float
    code: Literal["home_moves_here"] = "home_moves_here"
    english: ClassVar[Words] = Words(
        "The autopilot's home is {away_m} away. It moves here when the vehicle is armed, unless somebody has fixed it; "
        "then its own return leads there.",
        "If a ground station has set the home, set it to where the vehicle stands.",
    )


CheckReason = (
    HomeMovesHere
    | ReturnAltitudeChecked
    | ReturnAltitudeUnread
    | ReturnClimbs
    | ReturnMeetsGround
    | RoomToFly
    | StartAllowed
    | ReceiverDelivers
    | ReceiverTakesTurns
    | TurnTakesLong
    | FewTurnsOnABattery
    | FewTurnsOnThisCharge
    | FirstTurnInLittleWind
    | NoSamples
    | TagUnheard
    | PatternInUse
    | NoVehicleYet
    | ConnectingBroke
)
