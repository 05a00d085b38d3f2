"""Why recorded IQ of a turn cannot be used, and what was assumed where it says too little."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from hardware.reasons.channels import ImpossiblePulses, OutsideBand, SampleRateTooLow
from hardware.reasons.sweep import SweepReason
from planner.reason import Words

Field = Literal[
    "core:sample_rate",
    "core:frequency",
    "core:datetime",
    "core:geolocation",
    "core:dataset",
    "core:num_channels",
    "antenna:azimuth_angle",
]
STATE_IT = (
    "{field?core:sample_rate=State the samples a second, a number above zero|"
    "core:frequency=State one centre frequency in hertz; cut a recording that was retuned into one for each|"
    "core:datetime=State when the recording began, as in 2026-05-01T10:00:00Z, or write the times of the headings as "
    "seconds since then|core:geolocation=State a GeoJSON point on the earth, or leave it out|"
    "core:dataset=Remove it and name the .sigmf-data file like the .sigmf-meta file|"
    "core:num_channels=State of how many channels the samples are, one at least, or leave it out|"
    "antenna:azimuth_angle=State where the antenna pointed, in degrees, in two annotations at least, or give a table "
    "of time and heading beside the recording}."
)


@dataclass(frozen=True, slots=True)
class SigmfFieldMissing:
    file: str
    field: Field
    code: Literal["sigmf_field_missing"] = "sigmf_field_missing"

    english: ClassVar[Words] = Words("The recording {file} does not state {field}.", STATE_IT)


@dataclass(frozen=True, slots=True)
class SigmfFieldUnusable:
    """value: as it stands in the file."""

    file: str
    field: Field
    value: str
    code: Literal["sigmf_field_unusable"] = "sigmf_field_unusable"

    english: ClassVar[Words] = Words("In the recording {file}, {field} cannot be used: {value}.", STATE_IT)


@dataclass(frozen=True, slots=True)
class SigmfFileMissing:
    """missing: the name of the other file."""

    file: str
    missing: str
    code: Literal["sigmf_file_missing"] = "sigmf_file_missing"

    english: ClassVar[Words] = Words(
        "The recording {file} lacks its file {missing}.",
        "A recording is two files: .sigmf-meta says how it was sampled, .sigmf-data holds the samples.",
    )


@dataclass(frozen=True, slots=True)
class SamplesUnusable:
    file: str
    why: Literal["collection", "real", "none", "zero", "too_short"]
    code: Literal["samples_unusable"] = "samples_unusable"

    english: ClassVar[Words] = Words(
        "The recording {file} {why?collection=is a collection of several|real=holds real samples, not complex IQ|"
        "none=holds no sample|zero=is silent: every sample is zero|too_short=is too short for one power reading}.",
        "{why?collection=Give one recording|real=Record complex IQ|none=Check that its data file is complete|"
        "zero=Check that the receiver was running|too_short=Check its sample rate}.",
    )


@dataclass(frozen=True, slots=True)
class SamplesNotNumbers:
    """first_s: where the first of them stands, from the recording's beginning."""

    file: str
    samples: int
    first_s: float
    code: Literal["samples_not_numbers"] = "samples_not_numbers"

    english: ClassVar[Words] = Words(
        "In the recording {file}, {samples|sample is not a number|samples are not numbers}, the first after "
        "{first_s:2}.",
        "Cut them out, or check core:datatype.",
    )


@dataclass(frozen=True, slots=True)
class NoSignalFound:
    file: str
    needed_db: float
    code: Literal["no_signal_found"] = "no_signal_found"

    english: ClassVar[Words] = Words(
        "The recording {file} is silent: nothing stands {needed_db:0} above the noise.",
        "If the emitter is weaker than that, give its frequency.",
    )


@dataclass(frozen=True, slots=True)
class SilentAt:
    """above_db: the strongest reading over the noise."""

    file: str
    frequency_hz: float
    above_db: float
    code: Literal["silent_at"] = "silent_at"

    english: ClassVar[Words] = Words(
        "The recording {file} is silent at {frequency_hz}: the strongest reading stands {above_db} above the noise.",
        "Check the frequency.",
    )


@dataclass(frozen=True, slots=True)
class NoPulseAt:
    file: str
    frequency_hz: float
    code: Literal["no_pulse_at"] = "no_pulse_at"

    english: ClassVar[Words] = Words(
        "No pulse was heard at {frequency_hz} in the recording {file}.",
        "Check the frequency and the tag's pulse width and period.",
    )


@dataclass(frozen=True, slots=True)
class HeadingsApart:
    """from_s, to_s: first and last heading, from the recording's beginning. samples_s: its length."""

    file: str
    from_s: float
    to_s: float
    samples_s: float
    sample_rate_hz: float
    code: Literal["headings_apart"] = "headings_apart"

    english: ClassVar[Words] = Words(
        "The headings run from {from_s:1} to {to_s:1} after the beginning of the recording {file}, the samples only to "
        "{samples_s:1}.",
        "Check the times and the sample rate ({sample_rate_hz}).",
    )


@dataclass(frozen=True, slots=True)
class HeadingsOfOtherLength:
    file: str
    headings_s: float
    samples_s: float
    sample_rate_hz: float
    code: Literal["headings_of_other_length"] = "headings_of_other_length"

    english: ClassVar[Words] = Words(
        "The headings of {file} last {headings_s:1}, the samples {samples_s:1}; what they share is used.",
        "Check the recording's sample rate ({sample_rate_hz}).",
    )


@dataclass(frozen=True, slots=True)
class FirstChannelUsed:
    """channels: how many the samples of the file are interleaved from."""

    file: str
    channels: int
    code: Literal["first_channel_used"] = "first_channel_used"

    english: ClassVar[Words] = Words(
        "The recording {file} holds {channels} channels; the first is used.",
        "To use another one, write its samples to a recording of their own.",
    )


@dataclass(frozen=True, slots=True)
class StrongestUsed:
    file: str
    frequency_hz: float
    code: Literal["strongest_used"] = "strongest_used"

    english: ClassVar[Words] = Words(
        "The strongest signal in the recording {file}, at {frequency_hz}, is used.",
        "To use another signal, give its frequency.",
    )


@dataclass(frozen=True, slots=True)
class ReadingsWithoutHeading:
    file: str
    left_out: int
    readings: int
    code: Literal["readings_without_heading"] = "readings_without_heading"

    english: ClassVar[Words] = Words(
        "No heading is known for {left_out} of {readings|power reading|power readings} in the recording {file}; "
        "they are left out."
    )


@dataclass(frozen=True, slots=True)
class NotIq:
    """given: what only IQ can use."""

    file: str
    given: Literal["headings", "signal"]
    code: Literal["not_iq"] = "not_iq"

    english: ClassVar[Words] = Words(
        "The file {file} holds {given?headings=its own headings, and no IQ that needs a table of them|"
        "signal=powers, not IQ, so that no frequency and no pulses are looked for in it}.",
        "{given?headings=Leave the table of headings out.|signal=}",
    )


@dataclass(frozen=True, slots=True)
class RecordingUnusable:
    file: str
    because: SweepReason | SampleRateTooLow | OutsideBand | ImpossiblePulses
    code: Literal["recording_unusable"] = "recording_unusable"

    english: ClassVar[Words] = Words("The recording {file} cannot be used. {because}", "{because!remedy}")


IqRecordingReason = (
    SigmfFieldMissing
    | SigmfFieldUnusable
    | SigmfFileMissing
    | SamplesUnusable
    | SamplesNotNumbers
    | NoSignalFound
    | SilentAt
    | NoPulseAt
    | HeadingsApart
    | HeadingsOfOtherLength
    | FirstChannelUsed
    | StrongestUsed
    | ReadingsWithoutHeading
    | NotIq
    | RecordingUnusable
)
