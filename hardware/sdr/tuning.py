"""Where to tune so that one sampled band holds several emitters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from hardware.reasons.channels import BandTooNarrow

SPIKE_CLEAR = 0.15
"""Share of the sample rate that an emitter need be away from the centre, where cheap receivers have a spike."""


@dataclass(frozen=True, slots=True)
class Reach:
    """What must be sampled for one emitter: `reach_hz` to either side of its frequency."""

    frequency_hz: float
    reach_hz: float


def centre_hz(wanted: Sequence[Reach], sample_rate_hz: float) -> float | BandTooNarrow:
    """The centre that holds all of them, away from its own spike as far as it can; why there is none.

    Those asked for first are kept before those asked for later.
    """
    kept: list[Reach] = []
    refused: list[Reach] = []
    for one in wanted:
        (kept if width_hz([*kept, one]) <= sample_rate_hz else refused).append(one)
    if refused:
        return BandTooNarrow(sample_rate_hz, width_hz(wanted), tuple(one.frequency_hz for one in refused))
    lowest = max(one.frequency_hz + one.reach_hz for one in wanted) - sample_rate_hz / 2.0
    highest = min(one.frequency_hz - one.reach_hz for one in wanted) + sample_rate_hz / 2.0
    frequencies = sorted(one.frequency_hz for one in wanted)
    clear_hz = SPIKE_CLEAR * sample_rate_hz
    beside = (frequencies[-1] + clear_hz, frequencies[0] - clear_hz)
    between = ((below + above) / 2.0 for below, above in pairwise(frequencies))
    possible = [min(max(centre, lowest), highest) for centre in (*beside, *between)]
    return max(possible, key=lambda centre: min(clear_hz, *(abs(centre - f) for f in frequencies)))


def width_hz(wanted: Sequence[Reach]) -> float:
    """The sample rate that holds all of them."""
    top = max(one.frequency_hz + one.reach_hz for one in wanted)
    return top - min(one.frequency_hz - one.reach_hz for one in wanted)
