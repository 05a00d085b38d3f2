"""Several tags at one frequency, as a craft listens to them: whose each pulse was, as all pulses so far say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from hardware.direction_finding.rhythm import RhythmSorter, Whose
from hardware.readings import Pulses
from hardware.reasons.sweep import PulsesNotGiven

LEAST_KEPT_S = 120.0
PERIODS_KEPT = 30.0
"""So many of the slowest tag's: what was heard before tells no more of a pulse's place in the rhythm."""


@dataclass(slots=True)
class SharedFrequency:
    """tags: what they send, each of another rhythm."""

    tags: Sequence[Pulses]
    _sorter: RhythmSorter = field(init=False)
    _whose: dict[float, Whose] | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        kept_s = max(LEAST_KEPT_S, PERIODS_KEPT * max(tag.period_s for tag in self.tags))
        self._sorter = RhythmSorter(self.tags, kept_s)

    def take(self, at_s: float) -> None:
        """A pulse was heard."""
        self._sorter.take(at_s)
        self._whose = None

    def times_of(self, tag: Pulses) -> frozenset[float]:
        """When the pulses were heard that are this tag's."""
        number = self.tags.index(tag)
        return frozenset(at_s for at_s, whose in self._verdicts().items() if whose == number)

    def not_given(self, begin_s: float, end_s: float) -> PulsesNotGiven | None:
        """Those in [begin_s, end_s] that are no tag's, by why; None: all were."""
        there = [whose for at_s, whose in self._verdicts().items() if begin_s <= at_s <= end_s]
        overlapping, unclear, strangers = (there.count(why) for why in ("overlapping", "unclear", "stranger"))
        given = len(there) - overlapping - unclear - strangers
        return None if given == len(there) else PulsesNotGiven(given, overlapping, unclear, strangers)

    def _verdicts(self) -> Mapping[float, Whose]:
        if self._whose is None:
            self._whose = dict(zip(self._sorter.at_s, self._sorter.whose(), strict=True))
        return self._whose
