"""All reasons of the product as one union, told apart by `code`, as facts and the wire carry them.

Each room declares its own; those that hold another reason stand here, beside the union that they hold.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

from pydantic import Field
from typing_extensions import TypeAliasType

from backend.reasons.access import AccessReason
from backend.reasons.adapter import ByOneAdapter
from backend.reasons.checks import CheckReason
from backend.reasons.datagrams import DatagramReason
from backend.reasons.flight import FlightReason, OrderName, Way
from backend.reasons.maps import MapReason
from backend.reasons.refusals import RefusalReason
from backend.reasons.request import RequestReason
from backend.reasons.safety import SafetyReason
from backend.reasons.search import SearchReason
from backend.reasons.storage import StorageReason
from backend.reasons.terrain import TerrainReason
from backend.reasons.turning import TurnReason
from backend.reasons.ways import WaysReason
from backend.reasons.work import WorkReason
from hardware.readings import CheckName
from hardware.reasons.union import HardwareReason
from planner.reason import Reason as AnyReason
from planner.reason import Words
from planner.reasons import PlannerReason


@dataclass(frozen=True, slots=True)
class ToldBefore:
    """A sentence out of a journal of before reasons had names. Only the journal's upgrade makes one."""

    text: str
    remedy: str = ""
    code: Literal["told_before"] = "told_before"
    english: ClassVar[Words] = Words("{text}", "{remedy}")


@dataclass(frozen=True, slots=True)
class NoUsableBearing:
    """After the last attempt at this place, or before the next one."""

    because: Reason
    again: bool
    code: Literal["no_usable_bearing"] = "no_usable_bearing"
    english: ClassVar[Words] = Words(
        "{again?true=The sweep is taken again|false=No usable bearing here}: {because}", "{because!remedy}"
    )


@dataclass(frozen=True, slots=True)
class NotLocalized:
    """How the search ended without a claim. not_yet: what was missing, of every emitter."""

    because: Reason
    not_yet: tuple[Reason, ...] = ()
    code: Literal["not_localized"] = "not_localized"
    english: ClassVar[Words] = Words("Not localized. {because} {not_yet}")


@dataclass(frozen=True, slots=True)
class PlacesUsedUp:
    places: int
    code: Literal["places_used_up"] = "places_used_up"
    english: ClassVar[Words] = Words("{places|place was|places were} used, as many as the mission allows.")


@dataclass(frozen=True, slots=True)
class NoLongerLocalized:
    not_yet: tuple[Reason, ...] = ()
    code: Literal["no_longer_localized"] = "no_longer_localized"
    english: ClassVar[Words] = Words("No longer localized since a bearing was excluded. {not_yet}")


@dataclass(frozen=True, slots=True)
class ReceiverTrouble:
    because: Reason
    code: Literal["receiver_trouble"] = "receiver_trouble"
    english: ClassVar[Words] = Words("Receiver: {because}", "{because!remedy}")


@dataclass(frozen=True, slots=True)
class PreflightFailed:
    """The first blocking check that failed."""

    check: CheckName
    because: Reason
    code: Literal["preflight_failed"] = "preflight_failed"
    english: ClassVar[Words] = Words("Preflight: {because}", "{because!remedy}")


@dataclass(frozen=True, slots=True)
class Interrupted:
    because: Literal["later_mission", "unreadable"]
    code: Literal["interrupted"] = "interrupted"
    english: ClassVar[Words] = Words(
        "Interrupted: {because?later_mission=a mission started later is the one in the air"
        "|unreadable=it can no longer be read}."
    )


@dataclass(frozen=True, slots=True)
class OrderedAgainLater:
    """A step failed over a lost link."""

    because: Reason
    code: Literal["ordered_again_later"] = "ordered_again_later"
    english: ClassVar[Words] = Words("{because}", "It is ordered again when the vehicle is heard.")


@dataclass(frozen=True, slots=True)
class NotDone:
    """The vehicle has not done what was ordered. way: what was tried of it; next_way is tried next."""

    order: OrderName
    way: Way
    because: Reason
    next_way: Way
    next_in_s: float
    code: Literal["not_done"] = "not_done"
    english: ClassVar[Words] = Words(
        "{order?hold=The hold|return=The return|land=The landing|abort=The abort} is not done: {because} "
        "{next_way?hold=Holding is tried|return=The return is tried|land=Landing where it is is tried} in {next_in_s}.",
        "Another order takes its place. The pilot can take over at any time.",
    )


@dataclass(frozen=True, slots=True)
class Instead:
    """The vehicle refused what was ordered, and does this."""

    order: OrderName
    way: Way
    because: Reason
    code: Literal["instead"] = "instead"
    english: ClassVar[Words] = Words(
        "{order?hold=The hold|return=The return|land=The landing|abort=The abort} could not be done, so the vehicle "
        "{way?hold=holds|return=returns|land=lands where it is}. {because}",
        "Look at the vehicle. Another order takes its place.",
    )


@dataclass(frozen=True, slots=True)
class AutopilotFliesHome:
    """By its own return, ordered by us: it knows neither the mission's no-fly areas nor its altitude band."""

    because: Reason
    code: Literal["autopilot_flies_home"] = "autopilot_flies_home"
    english: ClassVar[Words] = Words(
        "The autopilot flies home by its own way, which knows no no-fly zones: {because}",
        "Watch it; hold stops it.",
    )


CompositeReason = (
    ToldBefore
    | NoUsableBearing
    | NotLocalized
    | PlacesUsedUp
    | NoLongerLocalized
    | ReceiverTrouble
    | PreflightFailed
    | Interrupted
    | OrderedAgainLater
    | NotDone
    | Instead
    | AutopilotFliesHome
)

ReasonUnion = TypeAliasType(
    "ReasonUnion",
    Annotated[
        PlannerReason
        | HardwareReason
        | AccessReason
        | CheckReason
        | DatagramReason
        | FlightReason
        | MapReason
        | RefusalReason
        | RequestReason
        | SafetyReason
        | SearchReason
        | StorageReason
        | TerrainReason
        | TurnReason
        | WaysReason
        | WorkReason
        | CompositeReason,
        Field(discriminator="code"),
    ],
)

REASONS = ByOneAdapter("Reason", lambda: ReasonUnion)
Reason = Annotated[AnyReason, REASONS]
"""Any of them. The type checker sees what all have in common: to compare unions of five hundred classes takes it
a minute. Every class that a room declares is in the union (tested)."""
