"""What a craft makes of several tags at one frequency: each hears its own pulses, the rest is counted."""

from __future__ import annotations

import numpy as np

from backend.craft.shared_frequency import SharedFrequency
from hardware.readings import Pulses
from hardware.reasons.sweep import PulsesNotGiven

TAGS = (Pulses(0.02, 1.3), Pulses(0.02, 1.05))


def heard(*more: float) -> tuple[SharedFrequency, set[float], set[float]]:
    first = {round(float(t), 6) for t in np.arange(0.4, 60.0, 1.3)}
    second = {round(float(t), 6) for t in np.arange(0.75, 60.0, 1.05)}
    shared = SharedFrequency(TAGS)
    for at_s in sorted(first | second | set(more)):
        shared.take(at_s)
    return shared, first, second


def test_each_tag_has_its_own_times_and_nobody_elses() -> None:
    shared, first, second = heard()
    assert shared.times_of(TAGS[0]) <= first
    assert shared.times_of(TAGS[1]) <= second
    assert len(shared.times_of(TAGS[0])) > 0.8 * len(first)
    assert len(shared.times_of(TAGS[1])) > 0.8 * len(second)


def test_what_no_tag_gets_is_counted_and_adds_up() -> None:
    shared, first, second = heard(30.31, 41.93)
    found = shared.not_given(0.0, 60.0)
    assert isinstance(found, PulsesNotGiven)
    assert found.given + found.overlapping + found.unclear + found.strangers == len(first | second) + 2
    assert found.given == len(shared.times_of(TAGS[0])) + len(shared.times_of(TAGS[1]))
    assert found.strangers + found.unclear >= 1
    assert shared.not_given(1000.0, 2000.0) is None


def test_a_pulse_more_changes_the_verdicts() -> None:
    shared, _, _ = heard()
    before = shared.times_of(TAGS[0])
    shared.take(max(before) + 1.3)
    assert shared.times_of(TAGS[0]) > before
