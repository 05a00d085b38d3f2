"""Why a turn gives no sweep, or a sweep no bearing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from hardware.reasons.receiver import NothingHeardInTurn
from planner.reason import Words


@dataclass(frozen=True, slots=True)
class NoPulseHeard:
    code: Literal["no_pulse_heard"] = "no_pulse_heard"

    english: ClassVar[Words] = Words(
        "No pulse of the tag was heard in any direction.", "Switch the tag on, or measure nearer to it."
    )


@dataclass(frozen=True, slots=True)
class NoHeadingHeard:
    code: Literal["no_heading_heard"] = "no_heading_heard"

    english: ClassVar[Words] = Words(
        "The vehicle reported no heading during the turn.", "Check its telemetry link and the rate of ATTITUDE."
    )


@dataclass(frozen=True, slots=True)
class HeadingsNotNumbers:
    code: Literal["headings_not_numbers"] = "headings_not_numbers"

    english: ClassVar[Words] = Words(
        "The vehicle's headings are not numbers.", "Calibrate its compass, or restart the autopilot."
    )


@dataclass(frozen=True, slots=True)
class NoPositionHeard:
    code: Literal["no_position_heard"] = "no_position_heard"

    english: ClassVar[Words] = Words("The vehicle reported no position during the turn.", "Wait for a GPS fix.")


@dataclass(frozen=True, slots=True)
class ClocksApart:
    """apart_s: from the one's last to the other's first."""

    apart_s: float
    code: Literal["clocks_apart"] = "clocks_apart"

    english: ClassVar[Words] = Words(
        "The power samples and the headings are {apart_s:1} apart.",
        "Set the clocks of receiver and vehicle by GPS or NTP.",
    )


@dataclass(frozen=True, slots=True)
class HeadingsInterrupted:
    """longest_s: headings further apart are not bridged."""

    longest_s: float
    code: Literal["headings_interrupted"] = "headings_interrupted"

    english: ClassVar[Words] = Words(
        "Wherever power was heard, the vehicle reported no heading for more than {longest_s:1}.",
        "Look for gaps in the telemetry.",
    )


@dataclass(frozen=True, slots=True)
class PowerNotNumbers:
    code: Literal["power_not_numbers"] = "power_not_numbers"

    english: ClassVar[Words] = Words("No power value of the sweep is a plausible number.", "Restart the receiver.")


@dataclass(frozen=True, slots=True)
class Overdriven:
    clipped: int
    samples: int
    code: Literal["overdriven"] = "overdriven"

    english: ClassVar[Words] = Words(
        "The receiver was overdriven: {clipped} of {samples} samples are clipped.",
        "Lower its gain, or measure further away.",
    )


@dataclass(frozen=True, slots=True)
class TooFewDirections:
    heard: int
    needed: int
    code: Literal["too_few_directions"] = "too_few_directions"

    english: ClassVar[Words] = Words(
        "Power was heard in only {heard|direction|directions}; at least {needed} around the circle are needed.",
        "Turn slower, or raise the receiver's sample rate.",
    )


@dataclass(frozen=True, slots=True)
class TurnIncomplete:
    heard_deg: float
    code: Literal["turn_incomplete"] = "turn_incomplete"

    english: ClassVar[Words] = Words(
        "Power was heard over only {heard_deg} of the turn.",
        "Turn once all the way round while the receiver listens, or nearer to the emitter.",
    )


@dataclass(frozen=True, slots=True)
class ConstantPower:
    code: Literal["constant_power"] = "constant_power"

    english: ClassVar[Words] = Words(
        "The receiver shows the same power in every direction: a constant, not a signal.",
        "Check its antenna input and its gain.",
    )


@dataclass(frozen=True, slots=True)
class NothingAboveNoise:
    needed_db: float
    code: Literal["nothing_above_noise"] = "nothing_above_noise"

    english: ClassVar[Words] = Words(
        "Nothing was heard: no direction is {needed_db:0} above the noise floor.", "Measure nearer to the emitter."
    )


@dataclass(frozen=True, slots=True)
class NoDirection:
    code: Literal["no_direction"] = "no_direction"

    english: ClassVar[Words] = Words("The sweep shows no direction: the power hardly changes with the heading.")


@dataclass(frozen=True, slots=True)
class UnlikeAntenna:
    """quality, needed: cosine similarity of sweep and pattern, [0, 1]."""

    quality: float
    needed: float
    code: Literal["unlike_antenna"] = "unlike_antenna"

    english: ClassVar[Words] = Words(
        "The sweep does not look like the antenna (similarity {quality:2}, at least {needed:2} is needed): "
        "reflections, interference or no signal."
    )


@dataclass(frozen=True, slots=True)
class DirectionInGap:
    gap_deg: float
    code: Literal["direction_in_gap"] = "direction_in_gap"

    english: ClassVar[Words] = Words(
        "The strongest direction lies in a gap of {gap_deg} where the receiver did not listen."
    )


@dataclass(frozen=True, slots=True)
class PatternBorrowed:
    """name: of the pattern that was used."""

    name: str
    code: Literal["pattern_borrowed"] = "pattern_borrowed"

    english: ClassVar[Words] = Words(
        "The bearing was found with the pattern of another antenna ({name}), so it is less certain.",
        "Measure the pattern of the antenna that flies: crossfix calibrate.",
    )


@dataclass(frozen=True, slots=True)
class OtherDirectionLikely:
    other_bearing_deg: float
    code: Literal["other_direction_likely"] = "other_direction_likely"

    english: ClassVar[Words] = Words(
        "The sweep fits {other_bearing_deg} nearly as well.", "Listen from another place, too."
    )


@dataclass(frozen=True, slots=True)
class LikelyOtherAntenna:
    """probability: that the sweep was heard with another antenna than the pattern's."""

    name: str
    probability: float
    code: Literal["likely_other_antenna"] = "likely_other_antenna"

    english: ClassVar[Words] = Words(
        "The sweep looks like that of another antenna than {name}: its main lobe alone was used.",
        "Check which antenna is mounted, and measure its pattern: crossfix calibrate.",
    )


@dataclass(frozen=True, slots=True)
class PulsesNotGiven:
    """Of a turn at a frequency at which several tags send: how many pulses were some tag's, and how many count for
    none, since two tags sent at once, since they could be more than one's, or since they fit no tag."""

    given: int
    overlapping: int
    unclear: int
    strangers: int
    code: Literal["pulses_not_given"] = "pulses_not_given"

    english: ClassVar[Words] = Words(
        "Several tags send at this frequency: {given} pulses were told apart; {overlapping} of two tags at once, "
        "{unclear} that could be more than one's and {strangers} that fit none count for no tag."
    )


@dataclass(frozen=True, slots=True)
class RhythmNotHeard:
    """given: pulses of other tags at its frequency. left: those that count for no tag."""

    given: int
    left: int
    code: Literal["rhythm_not_heard"] = "rhythm_not_heard"

    english: ClassVar[Words] = Words(
        "No pulse in the rhythm of this tag was heard; at its frequency there were {given} pulses of other tags, and "
        "{left} that count for none.",
        "Measure nearer to it; check its period and the jitter in the mission.",
    )


SweepRemark = PatternBorrowed | LikelyOtherAntenna | OtherDirectionLikely | PulsesNotGiven
"""What makes the bearing of a sweep less certain, without refusing it."""

SweepReason = (
    NothingHeardInTurn
    | NoPulseHeard
    | RhythmNotHeard
    | NoHeadingHeard
    | HeadingsNotNumbers
    | NoPositionHeard
    | ClocksApart
    | HeadingsInterrupted
    | PowerNotNumbers
    | Overdriven
    | TooFewDirections
    | TurnIncomplete
    | ConstantPower
    | NothingAboveNoise
    | NoDirection
    | UnlikeAntenna
    | DirectionInGap
)
