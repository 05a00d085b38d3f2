"""What the vehicle's checklist found, good or bad; the remedies count for the bad."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words

GpsFixName = Literal["no GPS", "no fix", "2D", "3D", "DGPS", "RTK float", "RTK fixed", "static", "PPP"]
FailsafeWatch = Literal[
    "station", "station_id", "station_time", "fence", "transmitter", "sticks", "offboard", "battery", "battery_critical"
]


_FIX = (
    "{fix?no GPS=No GPS|no fix=No fix|2D=2D fix|3D=3D fix|DGPS=DGPS fix|RTK float=RTK float fix"
    "|RTK fixed=RTK fixed|static=Static position|PPP=PPP fix}"
)


@dataclass(frozen=True, slots=True)
class LinkChecked:
    autopilot: Literal["px4", "ardupilot", "unknown"]
    code: Literal["link_checked"] = "link_checked"

    english: ClassVar[Words] = Words("{autopilot?px4=PX4|ardupilot=ArduPilot|unknown=An unknown autopilot} is heard.")


@dataclass(frozen=True, slots=True)
class GpsChecked:
    fix: GpsFixName
    satellites: int
    wanted_satellites: int
    code: Literal["gps_checked"] = "gps_checked"

    english: ClassVar[Words] = Words(
        f"{_FIX}, {{satellites|satellite|satellites}}.",
        "Wait for a 3D fix with at least {wanted_satellites|satellite|satellites} under open sky.",
    )


@dataclass(frozen=True, slots=True)
class SatellitesUnknown:
    """There is a fix, but the autopilot does not know of how many satellites."""

    fix: GpsFixName
    code: Literal["satellites_unknown"] = "satellites_unknown"

    english: ClassVar[Words] = Words(
        f"{_FIX}, but the autopilot does not know how many satellites it has.",
        "Look at the GPS receiver: its position cannot be judged.",
    )


@dataclass(frozen=True, slots=True)
class RemoteIdChecked:
    """state: silent: the transmitter reported before, but not lately; unknown: never."""

    state: Literal["good", "silent", "unknown"]
    code: Literal["remote_id_checked"] = "remote_id_checked"

    english: ClassVar[Words] = Words(
        "{state?good=The Remote ID transmitter works|silent=The Remote ID transmitter has fallen silent"
        "|unknown=No Remote ID transmitter reports its state}.",
        "{state?silent=Check its power and its cable"
        "|*=Where Remote ID is required, check the transmitter by other means before the flight}.",
    )


@dataclass(frozen=True, slots=True)
class RemoteIdRefuses:
    """text: the transmitter's own words."""

    text: str
    code: Literal["remote_id_refuses"] = "remote_id_refuses"

    english: ClassVar[Words] = Words(
        "The Remote ID transmitter is not ready for a flight: “{text}”.",
        "Mend what it says: often the operator's id or the operator's place is missing.",
    )


@dataclass(frozen=True, slots=True)
class NeverReported:
    what: Literal["gps", "position", "heading", "battery", "home", "own_checks"]
    code: Literal["never_reported"] = "never_reported"

    english: ClassVar[Words] = Words(
        "The autopilot has not reported {what?gps=its GPS|position=its position|heading=its heading"
        "|battery=the battery's charge|home=its home|own_checks=how its own checks stand}.",
        "{what?gps=Check that it has a GPS receiver|position=Wait until the autopilot knows where it is"
        "|heading=Check the compass: bearings need the vehicle's heading|battery=Set up the battery monitor"
        "|home=Wait until the autopilot has set its home (it needs GPS)"
        "|own_checks=Wait until it does, and check that it sends SYS_STATUS}.",
    )


@dataclass(frozen=True, slots=True)
class ReportAge:
    """age_s: since it was true, by the clock of this program."""

    what: Literal["position", "heading"]
    age_s: float
    code: Literal["report_age"] = "report_age"

    english: ClassVar[Words] = Words(
        "The {what?position=position|heading=heading} is {age_s:1} old.",
        "{what?position=Wait until the autopilot knows where it is"
        "|heading=Check the compass: bearings need the vehicle's heading}.",
    )


@dataclass(frozen=True, slots=True)
class BatteryCharge:
    charge_percent: float
    wanted_percent: float
    code: Literal["battery_charge"] = "battery_charge"

    english: ClassVar[Words] = Words("The battery holds {charge_percent}.", "Charge it to at least {wanted_percent}.")


@dataclass(frozen=True, slots=True)
class HomeSet:
    """WGS84 degrees."""

    lat: float
    lon: float
    code: Literal["home_set"] = "home_set"

    english: ClassVar[Words] = Words("Home is at {lat@lon}.")


@dataclass(frozen=True, slots=True)
class ArmingChecked:
    """state: of the autopilot's own checks; not every autopilot reports them. said: what it gave as its reasons, in its
    own words; empty when it said nothing lately."""

    state: Literal["ready", "not_ready", "not_in_this_mode", "in_the_air", "not_reported"]
    said: str = ""
    code: Literal["arming_checked"] = "arming_checked"

    english: ClassVar[Words] = Words(
        "{state?ready=The autopilot is ready to arm|not_ready=The autopilot is not ready to arm"
        "|not_in_this_mode=The autopilot is not ready to arm in its present mode"
        "|in_the_air=The vehicle is in the air|not_reported=The autopilot does not report whether it is ready to arm}."
        "{said?=|*= It says: “}{said}{said?=|*=”.}",
        "{state?not_in_this_mode=Select its mode for holding to learn whether it would arm in that"
        "|*=Read the autopilot's messages: its own checks refuse to arm}.",
    )


@dataclass(frozen=True, slots=True)
class ControlChecked:
    """who: has control; nobody: nobody else intervenes."""

    who: Literal["pilot", "failsafe", "nobody"]
    code: Literal["control_checked"] = "control_checked"

    english: ClassVar[Words] = Words(
        "{who?pilot=The pilot has control|failsafe=The autopilot's failsafe has control|nobody=Nobody is intervening}.",
        "{who?failsafe=Let it land|*=Give control back with the transmitter, then resume}.",
    )


_WATCHES = (
    "{watch?station=Ground station lost|station_id=The ground station that its failsafe watches"
    "|station_time=Seconds until it takes a silent ground station for lost"
    "|fence=Geofence left|transmitter=Transmitter lost|sticks=The pilot's sticks override automatic flight"
    "|offboard=Offboard link lost, which Crossfix does not use"
    "|battery=Battery low|battery_critical=Battery almost empty}"
)
_SET = (
    "Set {parameter} to {wanted}{watch?station=: else a vehicle without its station hovers until its battery is empty"
    "|station_id=, Crossfix' MAVLink system id: the autopilot does not notice the loss of any other"
    "|station_time=: 2 to 30 s; later, a vehicle without its station is left to itself for too long"
    "|fence=: else the autopilot only reports that the fence was left"
    "|transmitter= when a pilot stands by with a transmitter"
    "|sticks=: the pilot's sticks must end automatic flight at once|offboard="
    "|battery=: else a vehicle that nobody commands flies until its battery is empty"
    "|battery_critical=, in case it does not reach home}."
)


@dataclass(frozen=True, slots=True)
class FailsafeParameter:
    """value: as the autopilot has it; wanted: one that makes it act."""

    watch: FailsafeWatch
    parameter: str
    value: float
    wanted: int
    code: Literal["failsafe_parameter"] = "failsafe_parameter"

    english: ClassVar[Words] = Words(f"{_WATCHES}: {{parameter}} = {{value}}.", _SET)


@dataclass(frozen=True, slots=True)
class FailsafeUnread:
    watch: FailsafeWatch
    parameter: str
    wanted: int
    code: Literal["failsafe_unread"] = "failsafe_unread"

    english: ClassVar[Words] = Words(f"{_WATCHES}: {{parameter}} could not be read.", _SET)


@dataclass(frozen=True, slots=True)
class FailsafeWithoutThreshold:
    """It would act, but nothing sets it off. known: both thresholds were read."""

    watch: FailsafeWatch
    parameter: str
    voltage_parameter: str
    charge_parameter: str
    known: bool
    code: Literal["failsafe_without_threshold"] = "failsafe_without_threshold"

    english: ClassVar[Words] = Words(
        f"{_WATCHES}: {{parameter}} is set, but {{voltage_parameter}} and {{charge_parameter}} "
        "{known?true=are both 0: it never acts|false=could not both be read: it may never act}.",
        "Set {voltage_parameter} to the voltage, or {charge_parameter} to the mAh left, at which it is to act.",
    )


PreflightReason = (
    LinkChecked
    | GpsChecked
    | SatellitesUnknown
    | RemoteIdChecked
    | RemoteIdRefuses
    | NeverReported
    | ReportAge
    | BatteryCharge
    | HomeSet
    | ArmingChecked
    | ControlChecked
    | FailsafeParameter
    | FailsafeUnread
    | FailsafeWithoutThreshold
)
