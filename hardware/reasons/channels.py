"""Why a receiver cannot hear the channels that it is asked for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class NoChannel:
    code: Literal["no_channel"] = "no_channel"

    english: ClassVar[Words] = Words(
        "The receiver was asked for no channel.", "Name at least one emitter with its frequency."
    )


@dataclass(frozen=True, slots=True)
class FrequencyOutOfRange:
    frequency_hz: float
    code: Literal["frequency_out_of_range"] = "frequency_out_of_range"

    english: ClassVar[Words] = Words(
        "The receiver cannot tune to {frequency_hz}.", "Check the emitter's frequency, or use another receiver."
    )


@dataclass(frozen=True, slots=True)
class FrequencyTwice:
    frequency_hz: float
    code: Literal["frequency_twice"] = "frequency_twice"

    english: ClassVar[Words] = Words(
        "The receiver was asked for {frequency_hz} twice, and could not tell the two emitters apart.",
        "Look for one of them at a time.",
    )


@dataclass(frozen=True, slots=True)
class FrequencyNotAskedFor:
    frequency_hz: float
    code: Literal["frequency_not_asked_for"] = "frequency_not_asked_for"

    english: ClassVar[Words] = Words(
        "The receiver delivers samples at {frequency_hz}, which nobody asked for.", "Restart the receiver."
    )


@dataclass(frozen=True, slots=True)
class CarriersOnly:
    """frequency_hz: of the tag that sends pulses."""

    frequency_hz: float
    code: Literal["carriers_only"] = "carriers_only"

    english: ClassVar[Words] = Words(
        "This receiver measures carriers only, and the tag at {frequency_hz} sends pulses.",
        "Use a receiver that delivers IQ.",
    )


@dataclass(frozen=True, slots=True)
class OneChannelOnly:
    """asked: how many channels were asked for."""

    asked: int
    code: Literal["one_channel_only"] = "one_channel_only"

    english: ClassVar[Words] = Words(
        "This receiver hears one emitter at a time, and {asked} were asked for.",
        "Look for one of them at a time, or use a receiver that delivers IQ.",
    )


@dataclass(frozen=True, slots=True)
class BandTooNarrow:
    """refused_hz: the channels that do not fit beside the ones asked for before them; needed_hz: the sample rate that
    takes them all."""

    sample_rate_hz: float
    needed_hz: float
    refused_hz: tuple[float, ...]
    code: Literal["band_too_narrow"] = "band_too_narrow"

    english: ClassVar[Words] = Words(
        "At a sample rate of {sample_rate_hz} the receiver cannot hear {refused_hz} at the same time as the others.",
        "Raise the sample rate to {needed_hz}, or state in the mission how wide a band the receiver hears: then it "
        "hears them one after another.",
    )


@dataclass(frozen=True, slots=True)
class OutsideBand:
    """refused_hz: the channels that lie outside what is sampled around `centre_hz`."""

    sample_rate_hz: float
    centre_hz: float
    refused_hz: tuple[float, ...]
    code: Literal["outside_band"] = "outside_band"

    english: ClassVar[Words] = Words(
        "A sample rate of {sample_rate_hz} around {centre_hz} does not hold {refused_hz}.",
        "Tune closer, or raise the sample rate.",
    )


@dataclass(frozen=True, slots=True)
class RecordedElsewhere:
    recorded_hz: float
    wanted_hz: float
    code: Literal["recorded_elsewhere"] = "recorded_elsewhere"

    english: ClassVar[Words] = Words(
        "The recording was made at {recorded_hz}, not at {wanted_hz}.",
        "Give the emitter's frequency as recorded, or another recording.",
    )


@dataclass(frozen=True, slots=True)
class SampleRateTooLow:
    sample_rate_hz: float
    needed_hz: float
    code: Literal["sample_rate_too_low"] = "sample_rate_too_low"

    english: ClassVar[Words] = Words(
        "A sample rate of {sample_rate_hz} is too low.", "Raise the sample rate to at least {needed_hz}."
    )


@dataclass(frozen=True, slots=True)
class ImpossiblePulses:
    width_s: float
    period_s: float
    code: Literal["impossible_pulses"] = "impossible_pulses"

    english: ClassVar[Words] = Words(
        "A pulse of {width_s:3} every {period_s:3} is impossible.",
        "Give a width greater than zero and less than the period.",
    )


ChannelReason = (
    NoChannel
    | FrequencyOutOfRange
    | FrequencyTwice
    | FrequencyNotAskedFor
    | CarriersOnly
    | OneChannelOnly
    | BandTooNarrow
    | OutsideBand
    | RecordedElsewhere
    | SampleRateTooLow
    | ImpossiblePulses
)
