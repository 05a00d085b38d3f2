"""A tag's sweep is slow enough for its pulses, and goes round again until each heading was listened to enough."""

from __future__ import annotations

import numpy as np
import pytest
from equipment import spec

from backend.craft.listening import channel_of
from backend.craft.sweep_turns import complete
from backend.search.turn_schedule import MOST_TURNS, SLOWEST_DEG_S, turn_schedule
from backend.spec import EmitterSpec, MissionSpec, SensorSpec
from hardware.readings import HeadingSample, PowerSample, Pulses

PERIOD_S = 1.0


def tag(period_s: float = PERIOD_S) -> EmitterSpec:
    return EmitterSpec(emitter_id=f"tag-{period_s:.0f}", kind="pulsed", pulse_period_s=period_s)


def mission(*emitters: EmitterSpec, pulses: int = 2, rate: float = 30.0) -> MissionSpec:
    sensor = SensorSpec(pulses_per_heading=pulses, turn_rate_deg_s=rate)
    return spec(emitters or (tag(),)).model_copy(update={"sensor": sensor})


def rate_of(mission: MissionSpec) -> float:
    (once,) = turn_schedule(mission).rounds
    return once.rate_deg_s


def turned(seconds: float, degrees: float = 360.0, start: float = 0.0) -> list[HeadingSample]:
    return [HeadingSample(t, (start + degrees * t / seconds) % 360.0) for t in np.arange(0.0, seconds, 0.1)]


def turned_in_steps(seconds: float, start: float, step: float = 10.0) -> list[HeadingSample]:
    """The nose waits at each step."""
    pace = 360.0 / seconds
    return [HeadingSample(t, (start + step * (pace * t // step)) % 360.0) for t in np.arange(0.0, seconds, 0.1)]


def pulses(seconds: float, deaf: tuple[float, float] = (0.0, 0.0), first: float = 0.5) -> list[PowerSample]:
    """Every pulse, those heard between `deaf` seconds as missed."""
    moments = np.arange(first, seconds, PERIOD_S)
    return [PowerSample(t, 150e6, -60.0, detected=not deaf[0] <= t < deaf[1]) for t in moments]


def test_a_carrier_turns_as_specified() -> None:
    assert rate_of(spec()) == spec().sensor.turn_rate_deg_s


def test_a_tag_turns_slowly_enough_for_its_pulses_and_never_faster_than_specified() -> None:
    seconds = 360.0 / rate_of(mission())
    assert seconds >= 16 * 2 * PERIOD_S
    assert complete(tag(), 2, pulses(seconds), turned(seconds))
    assert rate_of(mission(rate=5.0)) == 5.0


def test_of_several_tags_the_slowest_sets_the_turn() -> None:
    slow = rate_of(mission(tag(2.0)))
    assert rate_of(mission(tag(), EmitterSpec(), tag(2.0))) == slow < rate_of(mission(tag()))


def test_bursts_every_fifty_seconds_are_turned_for_as_slowly_as_may_be() -> None:
    """A 406 MHz beacon: some eleven bursts in three turns, which is nine minutes of hovering."""
    beacon = EmitterSpec(
        frequency_hz=406.028e6, kind="pulsed", pulse_width_s=0.44, pulse_period_s=50.0, pulse_jitter_s=2.5
    )
    rate = rate_of(mission(beacon))
    assert rate == SLOWEST_DEG_S
    assert channel_of(beacon).pulses == Pulses(0.44, 50.0, 2.5)
    assert 10 < MOST_TURNS * 360.0 / rate / beacon.pulse_period_s < 12


@pytest.mark.parametrize("lost", [(8.0, 16.0), (0.0, 4.0)])
def test_headings_that_missed_their_pulses_ask_for_another_turn(lost: tuple[float, float]) -> None:
    assert not complete(tag(), 2, pulses(36.0, lost), turned(36.0))


@pytest.mark.parametrize("turning", [turned, turned_in_steps])
@pytest.mark.parametrize("start", np.arange(0.0, 22.5, 2.5))
def test_one_turn_is_enough_wherever_it_begins_and_whenever_the_tag_sends(turning, start: float) -> None:
    seconds = 360.0 / rate_of(mission())
    headings = turning(seconds, start=start)
    asked_again = [
        first
        for first in np.arange(0.0, PERIOD_S, 0.1)
        if not complete(tag(), 2, pulses(seconds, first=first), headings)
    ]
    assert asked_again == []


def test_one_pulse_that_was_missed_is_worth_no_other_turn() -> None:
    assert complete(tag(), 2, pulses(36.0, (8.0, 9.0)), turned(36.0))
    assert not complete(tag(), 1, pulses(18.0, (8.0, 10.0)), turned(18.0)), "of one pulse none is left"


def test_headings_that_were_listened_to_in_vain_for_long_ask_for_no_more() -> None:
    assert complete(tag(), 2, pulses(72.0, (20.0, 35.0)), turned(72.0))


def test_a_turn_that_was_too_fast_is_not_complete() -> None:
    assert not complete(tag(), 2, pulses(12.0), turned(12.0))
    assert not complete(tag(), 2, [], [])


def test_pulses_longer_than_their_period_are_refused() -> None:
    with pytest.raises(ValueError, match="shorter than the period"):
        EmitterSpec(kind="pulsed", pulse_width_s=0.5, pulse_period_s=0.4)
