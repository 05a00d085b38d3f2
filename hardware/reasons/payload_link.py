"""Why a payload's configuration cannot be used, or its talk with the server ended."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class OtherProtocol:
    """theirs, ours: the versions that payload and server speak. older: who of the two is behind."""

    theirs: int
    ours: int
    older: Literal["payload", "server"]
    code: Literal["other_protocol"] = "other_protocol"

    english: ClassVar[Words] = Words(
        "The payload speaks version {theirs} of the protocol, the server version {ours}.",
        "Update the {older?payload=payload's software|server=server}.",
    )


@dataclass(frozen=True, slots=True)
class MessageOutOfTurn:
    wrong: Literal["no_hello", "second_hello", "no_welcome"]
    code: Literal["message_out_of_turn"] = "message_out_of_turn"

    english: ClassVar[Words] = Words(
        "{wrong?no_hello=The payload did not say hello first|second_hello=The payload said hello twice|"
        "no_welcome=The server did not say welcome}.",
        "Check that both run Crossfix, and report it if they do.",
    )


@dataclass(frozen=True, slots=True)
class MessageNotUnderstood:
    """place: path of the field. problem: what the validation says."""

    place: str
    problem: str
    code: Literal["message_not_understood"] = "message_not_understood"

    english: ClassVar[Words] = Words(
        "A message was not understood ({place}: {problem}).", "Update both the payload's software and the server."
    )


@dataclass(frozen=True, slots=True)
class PayloadConnectedAgain:
    """name: the payload's."""

    name: str
    code: Literal["payload_connected_again"] = "payload_connected_again"

    english: ClassVar[Words] = Words(
        'The payload "{name}" has connected again, which ends the older connection.',
        "If there are two, give one of them another name.",
    )


@dataclass(frozen=True, slots=True)
class RefusedByServer:
    """says: the server's sentence."""

    says: str
    code: Literal["refused_by_server"] = "refused_by_server"

    english: ClassVar[Words] = Words('The server closed the connection and said "{says}".')


@dataclass(frozen=True, slots=True)
class ConfigurationUnreadable:
    path: str
    detail: str
    code: Literal["configuration_unreadable"] = "configuration_unreadable"

    english: ClassVar[Words] = Words(
        "The configuration {path} is not a readable TOML file ({detail}).", "Correct it, or write it again with --save."
    )


@dataclass(frozen=True, slots=True)
class ConfigurationEntryMissing:
    """option: what gives it on the command line."""

    entry: str
    option: str
    code: Literal["configuration_entry_missing"] = "configuration_entry_missing"

    english: ClassVar[Words] = Words(
        'The entry "{entry}" of the configuration is missing.', "Give --{option}, or write it into the file."
    )


@dataclass(frozen=True, slots=True)
class ConfigurationEntryWrong:
    """problem: what the validation says."""

    entry: str
    problem: str
    code: Literal["configuration_entry_wrong"] = "configuration_entry_wrong"

    english: ClassVar[Words] = Words('The entry "{entry}" of the configuration is wrong ({problem}).', "Correct it.")


@dataclass(frozen=True, slots=True)
class PulseTimingIncomplete:
    code: Literal["pulse_timing_incomplete"] = "pulse_timing_incomplete"

    english: ClassVar[Words] = Words(
        "A pulsed tag needs both the width of its pulses and their period.",
        "Give both --pulse-width-s and --pulse-period-s, or neither for a carrier.",
    )


PayloadLinkReason = (
    OtherProtocol
    | MessageOutOfTurn
    | MessageNotUnderstood
    | PayloadConnectedAgain
    | RefusedByServer
    | ConfigurationUnreadable
    | ConfigurationEntryMissing
    | ConfigurationEntryWrong
    | PulseTimingIncomplete
)
