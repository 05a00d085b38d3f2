"""Why a command is not carried out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class PlaceRefusedBefore:
    """near_m: to the refused place; least_m: how far another must be from it. Answers of before this was told stand in
    journals without the two: they were about exactly the same place."""

    near_m: float = 0.0
    least_m: float = 5.0
    code: Literal["place_refused_before"] = "place_refused_before"
    english: ClassVar[Words] = Words(
        "The place is {near_m:1} from one that the autopilot has refused to fly to.",
        "Choose a place {least_m} or more from it.",
    )


@dataclass(frozen=True, slots=True)
class NotStarted:
    code: Literal["not_started"] = "not_started"
    english: ClassVar[Words] = Words("The mission has not started.", "Start it first.")


@dataclass(frozen=True, slots=True)
class AlreadyStarted:
    code: Literal["already_started"] = "already_started"
    english: ClassVar[Words] = Words("The mission has started already.", "Draft a new one to fly again.")


@dataclass(frozen=True, slots=True)
class MissionOver:
    code: Literal["mission_over"] = "mission_over"
    english: ClassVar[Words] = Words("The mission has ended.", "Draft a new one.")


@dataclass(frozen=True, slots=True)
class NotHeld:
    code: Literal["not_held"] = "not_held"
    english: ClassVar[Words] = Words("The mission is not held.", "To go on from here, hold it first.")


@dataclass(frozen=True, slots=True)
class LaterOrderCounts:
    """One that was given first, and came last."""

    code: Literal["later_order_counts"] = "later_order_counts"
    english: ClassVar[Words] = Words("An order that was given later on the same page has been accepted already.")


@dataclass(frozen=True, slots=True)
class NoCountdown:
    code: Literal["no_countdown"] = "no_countdown"
    english: ClassVar[Words] = Words("Nothing counts down: the countdown is over, or was stopped before.")


@dataclass(frozen=True, slots=True)
class LandingAlready:
    code: Literal["landing_already"] = "landing_already"
    english: ClassVar[Words] = Words("The vehicle is landing at home already.", "Hold stops the landing.")


@dataclass(frozen=True, slots=True)
class OnTheWayHome:
    code: Literal["on_the_way_home"] = "on_the_way_home"
    english: ClassVar[Words] = Words("The vehicle is on its way home.", "Hold and resume first, to go on searching.")


@dataclass(frozen=True, slots=True)
class OnTheGround:
    code: Literal["on_the_ground"] = "on_the_ground"
    english: ClassVar[Words] = Words("The vehicle is on the ground.")


@dataclass(frozen=True, slots=True)
class AreaOnlyInHold:
    code: Literal["area_only_in_hold"] = "area_only_in_hold"
    english: ClassVar[Words] = Words("The search area can only be changed in hold.", "Hold, then change it.")


@dataclass(frozen=True, slots=True)
class NetsChanging:
    code: Literal["nets_changing"] = "nets_changing"
    english: ClassVar[Words] = Words(
        "The autopilot does not have the fence of the new search area yet.",
        "It is given it until it has it; return and landing do not wait.",
    )


@dataclass(frozen=True, slots=True)
class NoProposedPlace:
    code: Literal["no_proposed_place"] = "no_proposed_place"
    english: ClassVar[Words] = Words("No place is proposed.", "Wait for the planner's next place.")


@dataclass(frozen=True, slots=True)
class NoSuchBearing:
    code: Literal["no_such_bearing"] = "no_such_bearing"
    english: ClassVar[Words] = Words("This mission has no such bearing.", "Reload the page.")


@dataclass(frozen=True, slots=True)
class BearingOfAnother:
    code: Literal["bearing_of_another"] = "bearing_of_another"
    english: ClassVar[Words] = Words("This bearing was reported under another name.", "Ask an operator to exclude it.")


@dataclass(frozen=True, slots=True)
class BearingExcludedAlready:
    code: Literal["bearing_excluded_already"] = "bearing_excluded_already"
    english: ClassVar[Words] = Words("The bearing is excluded already.")


@dataclass(frozen=True, slots=True)
class BearingCountsAlready:
    code: Literal["bearing_counts_already"] = "bearing_counts_already"
    english: ClassVar[Words] = Words("The bearing was not left out.")


@dataclass(frozen=True, slots=True)
class LeftOutByAnother:
    by: str
    code: Literal["left_out_by_another"] = "left_out_by_another"
    english: ClassVar[Words] = Words(
        "{by} left it out.", "Ask {by}, or whoever controls the search, to count it again."
    )


@dataclass(frozen=True, slots=True)
class NoSuchSource:
    code: Literal["no_such_source"] = "no_such_source"
    english: ClassVar[Words] = Words("No bearing of this search comes from there.", "Reload the page.")


@dataclass(frozen=True, slots=True)
class MutedAlready:
    muted: bool
    code: Literal["muted_already"] = "muted_already"
    english: ClassVar[Words] = Words("The source is {muted?true=muted already|false=not muted}.")


@dataclass(frozen=True, slots=True)
class NoSuchAlert:
    code: Literal["no_such_alert"] = "no_such_alert"
    english: ClassVar[Words] = Words("There is no such open alert.", "It may have cleared by itself.")


@dataclass(frozen=True, slots=True)
class NoSuchCraft:
    craft_id: str
    code: Literal["no_such_craft"] = "no_such_craft"
    english: ClassVar[Words] = Words("No craft {craft_id} flies for this mission.", "Reload the page.")


@dataclass(frozen=True, slots=True)
class NoSuchEmitter:
    emitter_id: str
    code: Literal["no_such_emitter"] = "no_such_emitter"
    english: ClassVar[Words] = Words("This mission looks for no emitter {emitter_id}.", "Reload the page.")


@dataclass(frozen=True, slots=True)
class VehicleUnknown:
    code: Literal["vehicle_unknown"] = "vehicle_unknown"
    english: ClassVar[Words] = Words("Nothing is known of the vehicle.", "Connect the vehicle and ask again.")


@dataclass(frozen=True, slots=True)
class NoHome:
    code: Literal["no_home"] = "no_home"
    english: ClassVar[Words] = Words("The vehicle's home is not known yet.", "Wait for a GPS fix.")


@dataclass(frozen=True, slots=True)
class AnotherMissionFlies:
    name: str
    code: Literal["another_mission_flies"] = "another_mission_flies"
    english: ClassVar[Words] = Words(
        "Another mission is still flying: {name}.", "End it and let the vehicle land first."
    )


@dataclass(frozen=True, slots=True)
class NoMission:
    mission_id: str
    code: Literal["no_mission"] = "no_mission"
    english: ClassVar[Words] = Words("There is no mission {mission_id}.", "Look at the list of missions.")


@dataclass(frozen=True, slots=True)
class NotEditable:
    code: Literal["not_editable"] = "not_editable"
    english: ClassVar[Words] = Words(
        "The mission has started and can no longer be edited.",
        "In hold, change its search area; or draft a new mission.",
    )


@dataclass(frozen=True, slots=True)
class EditedMeanwhile:
    """by: who saved it last, "?" when that was not kept. seq: of the fact that did."""

    by: str
    seq: int
    code: Literal["edited_meanwhile"] = "edited_meanwhile"
    english: ClassVar[Words] = Words(
        "The mission has been saved since you opened it, by {by}.",
        "Look at what they saved; then save yours over it, or begin again from theirs.",
    )


@dataclass(frozen=True, slots=True)
class DraftedBefore:
    """A mission of the id that the request names is stored."""

    mission_id: str
    code: Literal["drafted_before"] = "drafted_before"
    english: ClassVar[Words] = Words("The mission {mission_id} was drafted before.", "Open it and edit it.")


@dataclass(frozen=True, slots=True)
class MissionFlies:
    """The antenna is checked on the ground only."""

    code: Literal["mission_flies"] = "mission_flies"
    english: ClassVar[Words] = Words("A mission is flying.", "Check the antenna when the vehicle is down.")


@dataclass(frozen=True, slots=True)
class StillUnderWay:
    """What is in the air stays in the list."""

    code: Literal["still_under_way"] = "still_under_way"
    english: ClassVar[Words] = Words("The mission is under way.", "Delete it when it is over and its vehicle is down.")


@dataclass(frozen=True, slots=True)
class WasDeleted:
    code: Literal["was_deleted"] = "was_deleted"
    english: ClassVar[Words] = Words(
        "The mission was deleted.", "Restore it first: it is among the deleted ones in the list of missions."
    )


@dataclass(frozen=True, slots=True)
class TooManyVariants:
    most: int
    code: Literal["too_many_variants"] = "too_many_variants"
    english: ClassVar[Words] = Words("This mission has {most} variants, the most it may.", "Forget one of them first.")


@dataclass(frozen=True, slots=True)
class ServerIsEnding:
    code: Literal["server_is_ending"] = "server_is_ending"
    english: ClassVar[Words] = Words(
        "The server is being ended: it only holds, returns and lands.", "Start it again first."
    )


@dataclass(frozen=True, slots=True)
class MissionDoesNotFly:
    code: Literal["mission_does_not_fly"] = "mission_does_not_fly"
    english: ClassVar[Words] = Words("The mission is not flying.", "Edit the draft, or draft a new mission.")


RefusalReason = (
    NotStarted
    | AlreadyStarted
    | MissionOver
    | NotHeld
    | LaterOrderCounts
    | NoCountdown
    | LandingAlready
    | OnTheWayHome
    | OnTheGround
    | AreaOnlyInHold
    | NetsChanging
    | NoProposedPlace
    | PlaceRefusedBefore
    | NoSuchBearing
    | BearingOfAnother
    | BearingExcludedAlready
    | BearingCountsAlready
    | LeftOutByAnother
    | NoSuchSource
    | MutedAlready
    | NoSuchAlert
    | NoSuchCraft
    | NoSuchEmitter
    | VehicleUnknown
    | NoHome
    | AnotherMissionFlies
    | NoMission
    | NotEditable
    | EditedMeanwhile
    | DraftedBefore
    | MissionFlies
    | MissionDoesNotFly
    | ServerIsEnding
    | StillUnderWay
    | WasDeleted
    | TooManyVariants
)
