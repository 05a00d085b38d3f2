"""What a turn before a known emitter says about the antenna, and why a flight around one gives no pattern."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from hardware.reasons.sweep import SweepReason
from planner.reason import Words


@dataclass(frozen=True, slots=True)
class AntennaAgrees:
    """Bearings in degrees clockwise from true north."""

    measured_deg: float
    true_deg: float
    quality: float
    code: Literal["antenna_agrees"] = "antenna_agrees"

    english: ClassVar[Words] = Words("Measured {measured_deg}, true {true_deg}, quality {quality:2}.")


@dataclass(frozen=True, slots=True)
class EmitterTooNear:
    distance_m: float
    least_m: float
    code: Literal["emitter_too_near"] = "emitter_too_near"

    english: ClassVar[Words] = Words("The emitter is only {distance_m} away.", "Turn at least {least_m} away from it.")


@dataclass(frozen=True, slots=True)
class AntennaDead:
    heard_db: float
    pattern_db: float
    code: Literal["antenna_dead"] = "antenna_dead"

    english: ClassVar[Words] = Words(
        "The power changes by only {heard_db} over the turn, the pattern by {pattern_db:0}: "
        "the antenna seems dead or not connected.",
        "Check the antenna's cable, connector and element, and that the test emitter is on.",
    )


@dataclass(frozen=True, slots=True)
class AntennaUnlikePattern:
    because: SweepReason
    code: Literal["antenna_unlike_pattern"] = "antenna_unlike_pattern"

    english: ClassVar[Words] = Words(
        "The sweep does not fit the antenna's pattern. {because}",
        "Check that this is the antenna of the chosen pattern, that its element is whole and that the emitter has the "
        "same polarization.",
    )


@dataclass(frozen=True, slots=True)
class AntennaAskew:
    """Bearings in degrees clockwise from true north. offset_deg: of the antenna's front to the nose, were it right."""

    true_deg: float
    measured_deg: float
    offset_deg: float
    code: Literal["antenna_askew"] = "antenna_askew"

    english: ClassVar[Words] = Words(
        "The emitter is at {true_deg} but was measured at {measured_deg}.",
        "Set the antenna's offset to {offset_deg}, or turn the antenna; if both are right, calibrate the compass.",
    )


@dataclass(frozen=True, slots=True)
class ReceiverClockOff:
    """offset_s: receiver's clock minus vehicle's."""

    offset_s: float
    code: Literal["receiver_clock_off"] = "receiver_clock_off"

    english: ClassVar[Words] = Words(
        "The receiver's clock is {offset_s:2} off the vehicle's.", "Set both by GPS or NTP, then turn again."
    )


@dataclass(frozen=True, slots=True)
class TooFewSamples:
    samples: int
    needed: int
    code: Literal["too_few_samples"] = "too_few_samples"

    english: ClassVar[Words] = Words(
        "The sweeps hold only {samples|sample|samples}; a pattern needs at least {needed}.",
        "Turn slower, or fly more sweeps.",
    )


@dataclass(frozen=True, slots=True)
class NoMagneticModel:
    year: int
    code: Literal["no_magnetic_model"] = "no_magnetic_model"

    english: ClassVar[Words] = Words(
        "There is no magnetic model for the year {year}.", "Update pygeomag, or set the declination by hand."
    )


@dataclass(frozen=True, slots=True)
class NotTheMeasuredAntenna:
    """name: of the pattern. repeats_db: what the sweeps deviate from it by alike. sweeps: how many show it."""

    name: str
    repeats_db: float
    sweeps: int
    code: Literal["not_the_measured_antenna"] = "not_the_measured_antenna"

    english: ClassVar[Words] = Words(
        "This is not the antenna that was measured: {sweeps} sweeps deviate from the pattern {name} by {repeats_db:1} "
        "in the same way.",
        "Check which antenna is mounted and how, or take over the proposed pattern.",
    )


AntennaReason = (
    AntennaAgrees
    | NotTheMeasuredAntenna
    | EmitterTooNear
    | AntennaDead
    | AntennaUnlikePattern
    | AntennaAskew
    | ReceiverClockOff
    | TooFewSamples
    | NoMagneticModel
)
