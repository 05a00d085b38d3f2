"""Whether the emitters of a specification can be told apart by a receiver: by frequency, or tags by their rhythm."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, groupby, pairwise

from backend.reasons.search import FrequenciesTooNear, FrequencyShared, RhythmsTooAlike, TooManyRhythms
from backend.search.errors import MissionInputError
from backend.spec import EmitterSpec
from hardware.sdr.pulses import PulseSetting
from hardware.sdr.spectrum import ToneSetting

MOST_TAGS = 4
"""At one frequency: of the pulses of more, one in six falls together with another's."""


def check_told_apart(emitters: Sequence[EmitterSpec]) -> None:
    """Raises MissionInputError. Not part of the specification's own validation: a mission of before must still be read,
    whose emitters at one frequency were all taken to be heard by each of its pulses."""
    by_frequency = sorted(enumerate(emitters), key=lambda one: one[1].frequency_hz)
    for (first, lower), (second, upper) in pairwise(by_frequency):
        needed_hz = max(_searched_hz(lower), _searched_hz(upper))
        if 0.0 < upper.frequency_hz - lower.frequency_hz < needed_hz:
            near = FrequenciesTooNear(lower.frequency_hz, upper.frequency_hz, needed_hz)
            raise MissionInputError(near, f"emitters.{max(first, second)}.frequency_hz")
    for frequency_hz, group in groupby(by_frequency, key=lambda one: one[1].frequency_hz):
        there = list(group)
        if len(there) == 1:
            continue
        last, _ = max(there, key=lambda one: one[0])
        if any(emitter.kind != "pulsed" for _, emitter in there):
            raise MissionInputError(FrequencyShared(frequency_hz), f"emitters.{last}.frequency_hz")
        if len(there) > MOST_TAGS:
            raise MissionInputError(TooManyRhythms(frequency_hz, MOST_TAGS), f"emitters.{last}.frequency_hz")
        for (_, one), (index, other) in combinations(there, 2):
            needed_s = least_apart_s(one, other)
            if abs(one.pulse_period_s - other.pulse_period_s) < needed_s - 1e-9:
                alike = RhythmsTooAlike(frequency_hz, one.pulse_period_s, other.pulse_period_s, needed_s)
                raise MissionInputError(alike, f"emitters.{index}.pulse_period_s")


def least_apart_s(one: EmitterSpec, other: EmitterSpec) -> float:
    """Between two periods: as each tag's true period may be off by its jitter, either could else be the other."""
    return max(one.pulse_jitter_s + other.pulse_jitter_s, (one.pulse_width_s + other.pulse_width_s) / 2.0)


def _searched_hz(emitter: EmitterSpec) -> float:
    """How far to either side of its frequency the receiver takes whatever is loudest for it."""
    return (ToneSetting() if emitter.kind == "carrier" else PulseSetting()).search_hz
