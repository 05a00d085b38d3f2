"""Why a receiver does not hear, or cannot be asked to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class ReceiverMisnamed:
    """device: the name as it was given."""

    device: str
    fault: Literal["form", "host", "port", "driver", "server"]
    code: Literal["receiver_misnamed"] = "receiver_misnamed"

    english: ClassVar[Words] = Words(
        'The receiver "{device}" {fault?form=is not understood|host=names no host|'
        "port=names a port that is not a number from 1 to 65535|driver=names no driver|server=names no server}.",
        "Write {fault?form=soapy:driver=NAME[,key=value], rtl_tcp://HOST[:PORT], sigmf:FILE or recording:FILE|"
        "host=rtl_tcp://HOST[:PORT]|port=rtl_tcp://HOST[:PORT]|"
        "driver=for instance driver=rtlsdr: a search without a driver would probe the network|"
        "server=driver=remote,remote=tcp://HOST:PORT: a search for servers would probe the network}.",
    )


@dataclass(frozen=True, slots=True)
class ReceiverNotOpen:
    code: Literal["receiver_not_open"] = "receiver_not_open"

    english: ClassVar[Words] = Words("The receiver is not open.", "Open it with its channels first.")


@dataclass(frozen=True, slots=True)
class ReceiverSilent:
    """quiet_s: how long it has delivered nothing."""

    quiet_s: float
    code: Literal["receiver_silent"] = "receiver_silent"

    english: ClassVar[Words] = Words(
        "The receiver has delivered nothing for {quiet_s}.",
        "Check its cable and driver, and that no other program uses it.",
    )


@dataclass(frozen=True, slots=True)
class NothingHeardInTurn:
    code: Literal["nothing_heard_in_turn"] = "nothing_heard_in_turn"

    english: ClassVar[Words] = Words(
        "The receiver delivered nothing during the turn.", "Check that it is running and tuned."
    )


@dataclass(frozen=True, slots=True)
class ReceiverStreamEnded:
    code: Literal["receiver_stream_ended"] = "receiver_stream_ended"

    english: ClassVar[Words] = Words(
        "The receiver's stream has ended.", "Look at the radio, or play the recording again."
    )


@dataclass(frozen=True, slots=True)
class ReceiverUnplugged:
    code: Literal["receiver_unplugged"] = "receiver_unplugged"

    english: ClassVar[Words] = Words("The receiver was unplugged.", "Plug it in again.")


@dataclass(frozen=True, slots=True)
class SamplesLost:
    """lost_percent: of the IQ samples of the last seconds."""

    lost_percent: float
    code: Literal["samples_lost"] = "samples_lost"

    english: ClassVar[Words] = Words(
        "The receiver lost {lost_percent} of its samples.",
        "Check that it is still connected; lower the sample rate if this computer is too slow for it.",
    )


@dataclass(frozen=True, slots=True)
class NonsensicalPower:
    """value: the power as the receiver gave it, dB; a text, because it need not be a number."""

    value: str
    code: Literal["nonsensical_power"] = "nonsensical_power"

    english: ClassVar[Words] = Words(
        "The receiver delivers a power of {value} dB, which is impossible; such samples are left out.",
        "Check the receiver and its driver.",
    )


@dataclass(frozen=True, slots=True)
class RecordedSweepEmpty:
    code: Literal["recorded_sweep_empty"] = "recorded_sweep_empty"

    english: ClassVar[Words] = Words("The recorded sweep holds no sample.", "Give another recording.")


ReceiverReason = (
    ReceiverMisnamed
    | ReceiverNotOpen
    | ReceiverSilent
    | NothingHeardInTurn
    | ReceiverStreamEnded
    | ReceiverUnplugged
    | SamplesLost
    | NonsensicalPower
    | RecordedSweepEmpty
)
