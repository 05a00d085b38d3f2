"""Why a craft does what it does: the reasons of its phases, orders and alerts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words

StepName = Literal["take_off", "fly", "measure", "plan", "belief", "hold", "return", "land"]
Way = Literal["hold", "return", "land"]
"""What a vehicle in the air can always be told."""
OrderName = Literal["hold", "return", "land", "abort"]


@dataclass(frozen=True, slots=True)
class Ordered:
    """Somebody ordered it. by: who."""

    order: Literal[
        "start", "resume", "hold", "return", "land", "abort", "override", "accept", "veto", "automatic", "exclude"
    ]
    by: str
    code: Literal["ordered"] = "ordered"
    english: ClassVar[Words] = Words(
        "{order?start=Started|resume=Resumed|hold=Held|return=Return ordered|land=Landing ordered|abort=Aborted"
        "|override=Place chosen|accept=Place accepted|veto=Place refused|automatic=Automatic acceptance armed"
        "|exclude=Bearing excluded} by {by}."
    )


@dataclass(frozen=True, slots=True)
class Proceeds:
    """Automatic control goes on because this is done."""

    after: Literal["climb", "plan", "flight", "bearing", "belief", "way_home", "area"]
    code: Literal["proceeds"] = "proceeds"
    english: ClassVar[Words] = Words(
        "{after?climb=At altitude|plan=The next place is chosen|flight=The place is reached"
        "|bearing=The bearing is taken|belief=The belief is updated|way_home=Above home"
        "|area=The search area has changed}."
    )


@dataclass(frozen=True, slots=True)
class NoConsole:
    stage: Literal["hold", "return"]
    code: Literal["no_console"] = "no_console"
    english: ClassVar[Words] = Words(
        "{stage?hold=No console is connected|return=No console came back}.", "Connect a console and resume."
    )


@dataclass(frozen=True, slots=True)
class VehicleLinkLost:
    """silent_s None: nothing was ever heard."""

    silent_s: float | None
    code: Literal["vehicle_link_lost"] = "vehicle_link_lost"
    english: ClassVar[Words] = Words(
        "The link to the vehicle is lost.", "Its own failsafe acts meanwhile. Restore the link."
    )


@dataclass(frozen=True, slots=True)
class PlaceUnknown:
    """The vehicle itself says so."""

    code: Literal["place_unknown"] = "place_unknown"
    english: ClassVar[Words] = Words(
        "The vehicle has lost GPS: it no longer knows where it is.",
        "Be ready to fly it by hand: its autopilot will soon land where it is.",
    )


@dataclass(frozen=True, slots=True)
class BatteryRunsLow:
    """Of a craft that flies for no mission."""

    charge_percent: float
    code: Literal["battery_runs_low"] = "battery_runs_low"
    english: ClassVar[Words] = Words(
        "The battery holds only {charge_percent}.",
        "Order the return or the landing: without a mission nobody reckons what the way home takes.",
    )


@dataclass(frozen=True, slots=True)
class PayloadLinkLost:
    code: Literal["payload_link_lost"] = "payload_link_lost"
    english: ClassVar[Words] = Words(
        "The link to the companion computer is lost.", "Check the companion's power and network."
    )


@dataclass(frozen=True, slots=True)
class BackAfterRestart:
    code: Literal["back_after_restart"] = "back_after_restart"
    english: ClassVar[Words] = Words("The server restarted.", "Look at the vehicle, then resume.")


@dataclass(frozen=True, slots=True)
class ServerEnds:
    code: Literal["server_ends"] = "server_ends"
    english: ClassVar[Words] = Words("The server is being ended.", "Start it again, look at the vehicle, then resume.")


@dataclass(frozen=True, slots=True)
class PilotFlies:
    """mode: as the autopilot names it, empty when the sticks took control. perhaps_failsafe: its failsafe enters that
    mode by itself, too."""

    mode: str
    perhaps_failsafe: bool = False
    code: Literal["pilot_flies"] = "pilot_flies"
    english: ClassVar[Words] = Words(
        "{perhaps_failsafe?true=The pilot or the autopilot's failsafe has|false=The pilot has} control"
        "{mode?=, taken with the sticks|*=: the vehicle is in }{mode}.",
        "Resume when the pilot has given control back.",
    )


@dataclass(frozen=True, slots=True)
class FailsafeFlies:
    """The autopilot is on its own way home or down, and why."""

    because: Literal[
        "silence", "link_lost", "server_away", "ordered_before", "battery", "transmitter", "position", "fence", "other"
    ]
    code: Literal["failsafe_flies"] = "failsafe_flies"
    english: ClassVar[Words] = Words(
        "The autopilot returns or lands by itself: {because?silence=it had not heard from here"
        "|link_lost=the link was lost|server_away=the server was away|ordered_before=as ordered earlier"
        "|battery=battery low|transmitter=transmitter lost|position=position lost|fence=geofence left"
        "|other=a failsafe of its own}.",
        "Resume to go on searching, or let it land.",
    )


@dataclass(frozen=True, slots=True)
class FailsafeStopped:
    """Nothing is sent: it might be a pilot."""

    mode: str
    code: Literal["failsafe_stopped"] = "failsafe_stopped"
    english: ClassVar[Words] = Words(
        "The autopilot's own way home ended in {mode}, perhaps by an earlier order.",
        "Look at the vehicle, then hold or resume.",
    )


@dataclass(frozen=True, slots=True)
class Landed:
    """The vehicle came down, and what the mission did then."""

    during: Literal["hold", "automatic", "manual", "localized"]
    code: Literal["landed"] = "landed"
    english: ClassVar[Words] = Words(
        "The vehicle landed {during?hold=while the mission was held|automatic=although nothing ordered it"
        "|manual=while the pilot or its own failsafe had control|localized=and the emitter is localized}.",
        "{during?manual=|localized=|*=Resume to take off again, abort to end the mission.}",
    )


@dataclass(frozen=True, slots=True)
class OtherAntenna:
    """After a restart. flown, given: names of the patterns, which may be the same for two contents of a file."""

    flown: str
    given: str
    code: Literal["other_antenna"] = "other_antenna"
    english: ClassVar[Words] = Words(
        "The server was restarted with another antenna pattern ({given}); this mission keeps its own ({flown}).",
        "Where the antenna itself was changed, land and begin another mission.",
    )


@dataclass(frozen=True, slots=True)
class StepBroke:
    """A fault of ours, not of the equipment; the log has the traceback."""

    step: StepName
    code: Literal["step_broke"] = "step_broke"
    english: ClassVar[Words] = Words(
        "{step?take_off=Taking off|fly=Flying|measure=Measuring|plan=Planning|belief=Updating the belief|hold=Holding"
        "|return=Returning|land=Landing} failed inside Crossfix.",
        "Look at the vehicle and resume, or order the return.",
    )


@dataclass(frozen=True, slots=True)
class WatchBroke:
    """A background task of ours failed and begins again."""

    watch: Literal["vehicle", "changes", "track"]
    code: Literal["watch_broke"] = "watch_broke"
    english: ClassVar[Words] = Words(
        "{watch?vehicle=Watching the vehicle|changes=Listening to the vehicle|track=Keeping the track} failed inside "
        "Crossfix.",
        "Look at the vehicle and resume, or order the return.",
    )


@dataclass(frozen=True, slots=True)
class PlaceUnsure:
    """The vehicle's reported position jumped, or wind moved it, while it measured."""

    place_number: int
    drift_m: float
    code: Literal["place_unsure"] = "place_unsure"
    english: ClassVar[Words] = Words(
        "The place of bearing {place_number} is uncertain by {drift_m}; it counts for less.",
        "Its reported position jumped, or wind moved it: look at GPS and wind.",
    )


@dataclass(frozen=True, slots=True)
class NotStored:
    detail: str
    code: Literal["not_stored"] = "not_stored"
    english: ClassVar[Words] = Words(
        "Not everything of this mission can be stored: {detail}.",
        "It is kept beside the journal's spool; the flight goes on.",
    )


FlightReason = (
    Ordered
    | Proceeds
    | NoConsole
    | VehicleLinkLost
    | PlaceUnknown
    | BatteryRunsLow
    | PayloadLinkLost
    | BackAfterRestart
    | ServerEnds
    | PilotFlies
    | FailsafeFlies
    | FailsafeStopped
    | Landed
    | OtherAntenna
    | StepBroke
    | WatchBroke
    | PlaceUnsure
    | NotStored
)
