"""Why a datagram on the bearings' UDP port is not taken."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class DatagramTooLong:
    size: int
    most: int
    code: Literal["datagram_too_long"] = "datagram_too_long"
    english: ClassVar[Words] = Words("It has {size} bytes; {most} are the most.", "Leave the raw directions out.")


@dataclass(frozen=True, slots=True)
class DatagramNoBearing:
    what: Literal["json", "bearing"]
    code: Literal["datagram_no_bearing"] = "datagram_no_bearing"
    english: ClassVar[Words] = Words(
        'It is {what?json=not JSON|bearing=no object of type "BEARING"}.',
        "Send one bearing in each datagram, and nothing else to this port.",
    )


@dataclass(frozen=True, slots=True)
class DatagramNotAbsolute:
    """Nobody tells the heading of the car that a relative bearing counts from."""

    code: Literal["datagram_not_absolute"] = "datagram_not_absolute"
    english: ClassVar[Words] = Words(
        'Its bearing_type is not "absolute".', "Send the bearing from true north, and the place."
    )


@dataclass(frozen=True, slots=True)
class DatagramValueUnreadable:
    """name: of the field, as it is sent."""

    name: str
    wanted: Literal["number", "text", "emitter"]
    code: Literal["datagram_value_unreadable"] = "datagram_value_unreadable"
    english: ClassVar[Words] = Words(
        "Its {name} is no {wanted?number=number|text=text|emitter=emitter's id}.", "Mend what the sender writes."
    )


@dataclass(frozen=True, slots=True)
class DatagramValueImpossible:
    """name: of the field, as it is sent."""

    name: str
    value: float
    least: float
    most: float
    code: Literal["datagram_value_impossible"] = "datagram_value_impossible"
    english: ClassVar[Words] = Words(
        "Its {name} is {value}; it must be between {least} and {most}.", "Mend what the sender writes."
    )


@dataclass(frozen=True, slots=True)
class SenderTooBusy:
    code: Literal["sender_too_busy"] = "sender_too_busy"
    english: ClassVar[Words] = Words("Its sender sends too many.", "Let it send at most five a second.")


@dataclass(frozen=True, slots=True)
class TooManyWait:
    code: Literal["too_many_wait"] = "too_many_wait"
    english: ClassVar[Words] = Words("Too many wait to be taken.", "Let the stations send less often.")


@dataclass(frozen=True, slots=True)
class SameErrorsAgain:
    """A station that stands still sends the same errors again and again."""

    station: str
    within_s: float
    code: Literal["same_errors_again"] = "same_errors_again"
    english: ClassVar[Words] = Words(
        "One of {station} from the same place was taken less than {within_s} ago; it has the same errors."
    )


@dataclass(frozen=True, slots=True)
class NoSearchFlies:
    code: Literal["no_search_flies"] = "no_search_flies"
    english: ClassVar[Words] = Words("No search flies.", "Start one; bearings for a draft are sent by HTTP.")


DatagramReason = (
    DatagramTooLong
    | DatagramNoBearing
    | DatagramNotAbsolute
    | DatagramValueUnreadable
    | DatagramValueImpossible
    | SenderTooBusy
    | TooManyWait
    | SameErrorsAgain
    | NoSearchFlies
)
