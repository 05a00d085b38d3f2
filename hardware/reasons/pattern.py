"""Why an antenna's pattern cannot be used."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from hardware.reasons.table import FileUnreadable, TooManyCells
from planner.reason import Words

A_PATTERN = "Use a file that crossfix calibrate wrote, or a turntable table of angle_deg, gain_db that ends in .csv."


@dataclass(frozen=True, slots=True)
class NotAPattern:
    """why: a key that is missing, or what is wrong with what stands there."""

    file: str
    why: Literal["json", "format", "relative_bearing_deg", "gain", "unit", "rows", "numbers", "counts", "positive"]
    code: Literal["not_a_pattern"] = "not_a_pattern"

    english: ClassVar[Words] = Words(
        "The file {file} is not an antenna pattern: {why?"
        'json=it is not JSON|format=it does not state the format "crossfix antenna pattern"|'
        "relative_bearing_deg=it lacks relative_bearing_deg|gain=it lacks gain|unit=it lacks unit|"
        "rows=it holds no rows of angle_deg, gain|numbers=an angle, gain, offset or frequency is not a finite number|"
        "counts=it does not have one gain for each angle|positive=a linear gain is not above zero}.",
        A_PATTERN,
    )


@dataclass(frozen=True, slots=True)
class PatternRowUnusable:
    file: str
    line: int
    row: str
    code: Literal["pattern_row_unusable"] = "pattern_row_unusable"

    english: ClassVar[Words] = Words(
        'Line {line} of {file} is not "angle_deg, gain": {row}.', "Repair or remove that line."
    )


@dataclass(frozen=True, slots=True)
class PatternUnitUnknown:
    file: str
    unit: str
    code: Literal["pattern_unit_unknown"] = "pattern_unit_unknown"

    english: ClassVar[Words] = Words(
        'The unit "{unit}" of the gains in {file} is not known.', 'Use "dB" or "linear power".'
    )


@dataclass(frozen=True, slots=True)
class TooFewPoints:
    name: str
    points: int
    needed: int
    code: Literal["too_few_points"] = "too_few_points"

    english: ClassVar[Words] = Words(
        "The pattern {name} has only {points|point|points}.", "Measure at least {needed} around the whole circle."
    )


@dataclass(frozen=True, slots=True)
class AngleTwice:
    """angle_deg: clockwise from the antenna's front."""

    name: str
    angle_deg: float
    code: Literal["angle_twice"] = "angle_twice"

    english: ClassVar[Words] = Words(
        "The angle {angle_deg:1} occurs twice in the pattern {name}.", "Keep one row for each angle."
    )


@dataclass(frozen=True, slots=True)
class PatternGap:
    """after_deg: clockwise from the antenna's front."""

    name: str
    gap_deg: float
    after_deg: float
    widest_deg: float
    code: Literal["pattern_gap"] = "pattern_gap"

    english: ClassVar[Words] = Words(
        "The pattern {name} has a gap of {gap_deg} after {after_deg}.",
        "Measure all the way round, at least every {widest_deg}.",
    )


@dataclass(frozen=True, slots=True)
class ImplausibleGains:
    name: str
    spread: Literal["small", "large"]
    limit_db: float
    code: Literal["implausible_gains"] = "implausible_gains"

    english: ClassVar[Words] = Words(
        "The gain of the pattern {name} varies by {spread?small=less than|large=more than} {limit_db:0} around the "
        "circle.",
        "Check that the antenna's element is whole, and the table's unit.",
    )


@dataclass(frozen=True, slots=True)
class PatternOfOtherFrequency:
    name: str
    measured_hz: float
    wanted_hz: float
    code: Literal["pattern_of_other_frequency"] = "pattern_of_other_frequency"

    english: ClassVar[Words] = Words(
        "The pattern {name} was measured at {measured_hz:1}, not at {wanted_hz:1}.",
        "Use a pattern that was measured at the emitter's frequency.",
    )


PatternReason = (
    NotAPattern
    | PatternRowUnusable
    | PatternUnitUnknown
    | TooFewPoints
    | AngleTwice
    | PatternGap
    | ImplausibleGains
    | PatternOfOtherFrequency
    | FileUnreadable
    | TooManyCells
)
