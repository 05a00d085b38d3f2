"""Why a radio, or the program that serves it, does not work: SoapySDR and rtl_tcp."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class SoapyMissing:
    code: Literal["soapy_missing"] = "soapy_missing"

    english: ClassVar[Words] = Words(
        "SoapySDR is not installed for this Python.",
        "Install the system package python3-soapysdr (and the module of your radio) and make SoapySDR.py visible in "
        "this environment (the user guide says how), or use an rtl_tcp:// receiver.",
    )


@dataclass(frozen=True, slots=True)
class RadioFailed:
    """device: its string. says: the driver's own words."""

    device: str
    stage: Literal["call", "start", "read"]
    says: str
    code: Literal["radio_failed"] = "radio_failed"

    english: ClassVar[Words] = Words(
        'The radio "{device}" {stage?call=reports a fault|start=does not start|read=has stopped delivering} ({says}).',
        "Check the device string and the cable.",
    )


@dataclass(frozen=True, slots=True)
class NoReceiveChannel:
    device: str
    code: Literal["no_receive_channel"] = "no_receive_channel"

    english: ClassVar[Words] = Words('The radio "{device}" has no receive channel.', "Use a radio that can receive.")


@dataclass(frozen=True, slots=True)
class TunedElsewhere:
    device: str
    tuned_hz: float
    wanted_hz: float
    code: Literal["tuned_elsewhere"] = "tuned_elsewhere"

    english: ClassVar[Words] = Words(
        'The radio "{device}" tuned to {tuned_hz} instead of {wanted_hz}.', "Check that this is in its range."
    )


@dataclass(frozen=True, slots=True)
class RtlSdrSampleRate:
    sample_rate_hz: float
    code: Literal["rtl_sdr_sample_rate"] = "rtl_sdr_sample_rate"

    english: ClassVar[Words] = Words(
        "An RTL-SDR cannot sample at {sample_rate_hz}.",
        "Choose from 225001 to 300000 or from 900001 to 3200000 samples a second.",
    )


@dataclass(frozen=True, slots=True)
class RtlTcpUnreachable:
    """detail: the operating system's words."""

    address: str
    detail: str
    code: Literal["rtl_tcp_unreachable"] = "rtl_tcp_unreachable"

    english: ClassVar[Words] = Words("The rtl_tcp server at {address} cannot be reached ({detail}).", "Start it there.")


@dataclass(frozen=True, slots=True)
class RtlTcpBusy:
    """closed: whether it hung up, or did not answer."""

    address: str
    closed: bool
    code: Literal["rtl_tcp_busy"] = "rtl_tcp_busy"

    english: ClassVar[Words] = Words(
        "The rtl_tcp server at {address} {closed?true=closed the connection|false=does not answer}.",
        "Check that it is running and that no other client is connected to it.",
    )


@dataclass(frozen=True, slots=True)
class NotRtlTcp:
    address: str
    code: Literal["not_rtl_tcp"] = "not_rtl_tcp"

    english: ClassVar[Words] = Words(
        "The program that listens at {address} is not an rtl_tcp server.", "Correct the address."
    )


@dataclass(frozen=True, slots=True)
class RtlTcpEnded:
    """broken: the connection broke, and the server did not end the stream."""

    address: str
    broken: bool
    code: Literal["rtl_tcp_ended"] = "rtl_tcp_ended"

    english: ClassVar[Words] = Words(
        "{broken?true=The connection to the rtl_tcp server at|false=The stream of the rtl_tcp server at} {address} "
        "{broken?true=broke|false=ended}.",
        "Check its radio and the network.",
    )


RadioReason = (
    SoapyMissing
    | RadioFailed
    | NoReceiveChannel
    | TunedElsewhere
    | RtlSdrSampleRate
    | RtlTcpUnreachable
    | RtlTcpBusy
    | NotRtlTcp
    | RtlTcpEnded
)
