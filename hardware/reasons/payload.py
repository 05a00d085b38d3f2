"""How a payload's receiver is, and why a payload does not deliver."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class PayloadStarting:
    code: Literal["payload_starting"] = "payload_starting"

    english: ClassVar[Words] = Words("The payload is opening its receiver.")


@dataclass(frozen=True, slots=True)
class PayloadListening:
    """channels: to how many emitters."""

    channels: int
    code: Literal["payload_listening"] = "payload_listening"

    english: ClassVar[Words] = Words("The payload listens to {channels|emitter|emitters}.")


@dataclass(frozen=True, slots=True)
class PayloadStateUnknown:
    """told: the code that the payload sent."""

    told: str
    code: Literal["payload_state_unknown"] = "payload_state_unknown"

    english: ClassVar[Words] = Words(
        'The payload\'s receiver is in a state that this server does not know ("{told}").', "Update the server."
    )


@dataclass(frozen=True, slots=True)
class NoPayloadConnected:
    code: Literal["no_payload_connected"] = "no_payload_connected"

    english: ClassVar[Words] = Words(
        "No payload is connected.", "Check that its agent is running (crossfix payload), its link and its token."
    )


@dataclass(frozen=True, slots=True)
class PayloadAway:
    """away_s: how long none was connected."""

    away_s: float
    code: Literal["payload_away"] = "payload_away"

    english: ClassVar[Words] = Words("No payload was connected for {away_s}.", "Check its power and its link.")


@dataclass(frozen=True, slots=True)
class PayloadTokensMissing:
    code: Literal["payload_tokens_missing"] = "payload_tokens_missing"

    english: ClassVar[Words] = Words(
        "The chosen receiver is a payload's, but no payload may connect.",
        "Give the server the tokens of its payloads in CROSSFIX_PAYLOAD_TOKENS.",
    )


@dataclass(frozen=True, slots=True)
class SpoolUnusable:
    """path: of its file. detail: the database's or the operating system's words."""

    path: str
    detail: str
    code: Literal["spool_unusable"] = "spool_unusable"

    english: ClassVar[Words] = Words(
        "The payload's spool {path} cannot be used ({detail}).",
        "Check that the disk is writable, or name another directory.",
    )


@dataclass(frozen=True, slots=True)
class SpoolNotWritten:
    detail: str
    code: Literal["spool_not_written"] = "spool_not_written"

    english: ClassVar[Words] = Words(
        "The payload's spool cannot be written ({detail}).", "Check whether its disk is full."
    )


PayloadReason = (
    PayloadStarting
    | PayloadListening
    | PayloadStateUnknown
    | NoPayloadConnected
    | PayloadAway
    | PayloadTokensMissing
    | SpoolUnusable
    | SpoolNotWritten
)
