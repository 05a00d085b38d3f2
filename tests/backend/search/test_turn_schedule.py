"""Which emitters a turn listens to one after another, how fast it turns for each, and what all of it takes."""

from __future__ import annotations

import pytest
from equipment import spec
from hypothesis import given
from hypothesis import strategies as st

from backend.search.turn_schedule import CHANGE_S, SLICES, SPARE, heard_at_once, turn_s, turn_schedule
from backend.spec import EmitterSpec, MissionSpec

REACH_HZ = {"carrier": 3_200.0, "pulsed": 2_000.0}


def emitter(number: int, frequency_hz: float, period_s: float | None = None) -> EmitterSpec:
    kind = "carrier" if period_s is None else "pulsed"
    return EmitterSpec(
        emitter_id=f"e-{number}",
        frequency_hz=frequency_hz,
        kind=kind,
        pulse_period_s=1.3 if period_s is None else period_s,
    )


def mission(*emitters: EmitterSpec, band_hz: float | None = None, stated_s: float = 45.0) -> MissionSpec:
    made = spec(emitters)
    sensor = made.sensor.model_copy(
        update={"receiver_band_hz": band_hz, "measurement_time_s": stated_s, "turn_rate_deg_s": 30.0}
    )
    return made.model_copy(update={"sensor": sensor})


FOUR = tuple(emitter(k, 150e6 + 100e3 * k, 1.3) for k in range(4))


def test_a_receiver_that_hears_all_turns_once_for_the_slowest_tag() -> None:
    (once,) = turn_schedule(mission(*FOUR, emitter(9, 868e6), emitter(5, 150.5e6, 2.0))).rounds
    assert [e.emitter_id for e in once.emitters] == ["e-0", "e-1", "e-2", "e-3", "e-9", "e-5"]
    assert once.seconds == pytest.approx(SLICES * 2 * 2.0 * SPARE)


def test_channels_one_after_another_take_a_turn_each() -> None:
    narrow = turn_schedule(mission(*FOUR, band_hz=25e3))
    assert [len(one.emitters) for one in narrow.rounds] == [1, 1, 1, 1]
    each_s = SLICES * 2 * 1.3 * SPARE
    assert narrow.seconds == pytest.approx(4 * each_s + 3 * CHANGE_S)


def test_what_fits_into_the_band_is_heard_together() -> None:
    rounds = turn_schedule(mission(*FOUR, band_hz=110e3)).rounds
    assert [[e.emitter_id for e in one.emitters] for one in rounds] == [["e-0", "e-1"], ["e-2", "e-3"]]


def test_found_emitters_are_not_turned_for_but_heard_where_that_is_free() -> None:
    pairs = mission(*FOUR, band_hz=110e3)
    (last,) = turn_schedule(pairs, {"e-3"}).rounds
    assert [e.emitter_id for e in last.emitters] == ["e-2", "e-3"]
    slow = mission(emitter(0, 150e6, 1.3), emitter(1, 150.01e6, 3.0), band_hz=110e3)
    (once,) = turn_schedule(slow, {"e-0"}).rounds
    assert once.seconds == pytest.approx(SLICES * 2 * 1.3 * SPARE), "the slow one is found"


def test_the_time_of_a_turn_is_the_stated_one_unless_it_cannot_be() -> None:
    assert turn_s(mission(*FOUR)) == 45.0
    assert turn_s(mission(*FOUR, band_hz=25e3)) == pytest.approx(turn_schedule(mission(*FOUR, band_hz=25e3)).seconds)
    beacon = mission(emitter(0, 406.025e6, 50.0), stated_s=30.0)
    assert turn_s(beacon) == turn_schedule(beacon).seconds == 3 * 180.0, "no slower than two degrees a second"


@given(
    st.lists(st.tuples(st.integers(0, 400), st.booleans()), min_size=1, max_size=12, unique_by=lambda one: one[0]),
    st.floats(7_000.0, 500_000.0),
)
def test_every_emitter_is_in_one_group_that_fits_and_no_fewer_groups_would_do(
    drawn: list[tuple[int, bool]], band_hz: float
) -> None:
    emitters = [emitter(k, 150e6 + 1e3 * khz, 1.3 if tag else None) for k, (khz, tag) in enumerate(drawn)]
    groups = heard_at_once(emitters, band_hz)
    assert sorted(e.emitter_id for group in groups for e in group) == sorted(e.emitter_id for e in emitters)
    for group in groups:
        low = min(e.frequency_hz - REACH_HZ[e.kind] for e in group)
        assert max(e.frequency_hz + REACH_HZ[e.kind] for e in group) - low <= band_hz + 1e-6
    # emitters further apart than the band must be in different groups: as many as fit apart are needed
    apart, beyond = 0, -1.0
    for one in sorted(emitters, key=lambda e: e.frequency_hz):
        if one.frequency_hz - 2_000.0 > beyond:
            apart, beyond = apart + 1, one.frequency_hz + band_hz
    assert len(groups) >= apart


def test_a_turn_takes_less_once_emitters_are_found() -> None:
    narrow = mission(*FOUR, band_hz=25e3)
    assert turn_s(narrow, ["e-1"]) == turn_s(mission(*FOUR[:1], band_hz=25e3)) < turn_s(narrow) / 3
    assert turn_s(narrow, []) == turn_s(narrow), "nobody is looked for by name: all are"
    beacon = mission(emitter(0, 406.025e6, 50.0), emitter(1, 406.1e6), stated_s=30.0)
    assert turn_s(beacon, ["e-1"]) == 30.0
    assert turn_s(mission(*FOUR), ["e-1"]) == turn_s(mission(*FOUR)), "all are heard at once"
