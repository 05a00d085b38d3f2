"""Emitters at one frequency: tags whose rhythms differ enough; nothing else can be told apart."""

from __future__ import annotations

from typing import Any

import pytest
from refusals import refusing

from backend.reasons.search import FrequenciesTooNear, FrequencyShared, RhythmsTooAlike, TooManyRhythms
from backend.search.errors import MissionInputError
from backend.search.told_apart import MOST_TAGS, check_told_apart
from backend.spec import EmitterSpec


def tag(period_s: float, frequency_hz: float = 150e6, **changes: Any) -> EmitterSpec:
    return EmitterSpec(
        emitter_id=f"tag-{period_s * 1000:.0f}-{frequency_hz:.0f}",
        frequency_hz=frequency_hz,
        kind="pulsed",
        pulse_period_s=period_s,
        **changes,
    )


def test_rhythms_that_differ_by_both_jitters_are_enough() -> None:
    check_told_apart([tag(1.3), tag(1.24), tag(1.3, 151e6), EmitterSpec()])
    check_told_apart([tag(1.3, pulse_jitter_s=0.01), tag(1.28, pulse_jitter_s=0.01)])


@pytest.mark.parametrize("order", [1, -1])
def test_rhythms_too_much_alike_are_refused_with_what_would_do(order: int) -> None:
    emitters = [tag(1.3), tag(1.25), tag(2.0)][::order]
    first, second = (e.pulse_period_s for e in emitters if e.pulse_period_s < 2.0)
    with refusing(RhythmsTooAlike(150e6, first, second, 0.06), MissionInputError):
        check_told_apart(emitters)
    with refusing(RhythmsTooAlike(150e6, 1.3, 1.3, 0.02), MissionInputError):
        check_told_apart([tag(1.3, pulse_jitter_s=0.0), tag(1.3, pulse_jitter_s=0.0)])


def test_a_carrier_shares_its_frequency_with_nobody() -> None:
    for other in (EmitterSpec(frequency_hz=150e6), tag(1.3)):
        with refusing(FrequencyShared(150e6), MissionInputError):
            check_told_apart([EmitterSpec(frequency_hz=150e6), EmitterSpec(frequency_hz=1e6), other])


def test_too_many_tags_at_one_frequency_are_refused() -> None:
    tags = [tag(1.0 + 0.3 * k) for k in range(MOST_TAGS + 1)]
    check_told_apart(tags[:MOST_TAGS])
    with refusing(TooManyRhythms(150e6, MOST_TAGS), MissionInputError):
        check_told_apart(tags)


@pytest.mark.parametrize("apart_hz", [1.0, 100.0, 1_999.0])
def test_frequencies_that_one_channel_hears_together_are_refused(apart_hz: float) -> None:
    """Each would be given the louder one's pulses."""
    for pair in ([tag(1.3), tag(1.3, 150e6 + apart_hz)], [tag(1.05, 150e6 + apart_hz), tag(1.3)]):
        with refusing(FrequenciesTooNear(150e6, 150e6 + apart_hz, 2_000.0), MissionInputError):
            check_told_apart(pair)
    check_told_apart([tag(1.3), tag(1.3, 150.002e6)])


def test_a_carrier_is_searched_for_further_than_a_tag() -> None:
    carriers = [EmitterSpec(frequency_hz=868e6), EmitterSpec(frequency_hz=868.0025e6)]
    with refusing(FrequenciesTooNear(868e6, 868.0025e6, 3_000.0), MissionInputError):
        check_told_apart(carriers)
    with refusing(FrequenciesTooNear(150e6, 150.0025e6, 3_000.0), MissionInputError):
        check_told_apart([tag(1.3), EmitterSpec(frequency_hz=150.0025e6)])
    check_told_apart([EmitterSpec(frequency_hz=868e6), EmitterSpec(frequency_hz=868.003e6)])
