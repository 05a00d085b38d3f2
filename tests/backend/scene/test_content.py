"""The fold of a mission's facts into what its scene shows."""

from __future__ import annotations

import numpy as np
import pytest
from narrowing import known

from backend.events import BearingExcluded, MissionEnded, Recorded
from backend.reasons.search import Localized
from backend.scene.content import content, read_story
from backend.spec import FIRST_EMITTER


def at_end(recorded, track=(), upto_seq=None):
    return content(known(read_story(recorded, upto_seq)), track, None)


def more(recorded, *events):
    extra = []
    for index, event in enumerate(events, start=len(recorded) + 1):
        extra.append(Recorded(seq=index, mission_id="m1", at_utc=recorded[-1].at_utc, event=event))
    return [*recorded, *extra]


def test_positions_are_metres_around_the_home(recorded) -> None:
    shown = at_end(recorded)
    assert shown.home == (0.0, 0.0)
    assert shown.area.bounds == pytest.approx((-150, -10, 170, 210), abs=0.05)
    assert shown.fence.contains(shown.area)
    assert [zone.bounds for zone in shown.no_fly] == [pytest.approx((90, 100, 140, 150), abs=0.05)]
    (planned,) = shown.next_places
    assert (planned.x, planned.y) == pytest.approx((120, 190), abs=0.05)


def test_sweeps_carry_their_bearing_height_and_power(recorded) -> None:
    sweeps = at_end(recorded).sweeps
    rejected, first, second, _ = sweeps
    assert (rejected.bearing_deg, rejected.counted) == (None, False)
    assert np.isnan(rejected.power_db[:90]).all()
    assert (first.x, first.y, first.z) == pytest.approx((0, 20, 40), abs=0.05)
    assert first.counted
    assert [weight for _, weight in second.peaks] == [0.3]


def test_a_bearing_without_a_sweep_is_of_no_quality(recorded) -> None:
    (measured, *_) = (record.event for record in recorded if record.event.kind == "bearing_measured")
    told = measured.model_copy(update={"bearing_id": "t1", "sweep_id": None, "quality": 1.0, "binned_db": []})
    assert [sweep.quality for sweep in at_end(more(recorded, told)).sweeps] == [0.4, 0.9, 0.9, 0.9, None]


def test_an_excluded_bearing_stays_visible_but_does_not_count(recorded) -> None:
    shown = at_end(more(recorded, BearingExcluded(emitter_id=FIRST_EMITTER, bearing_id="b1", by="op", reason="")))
    assert [sweep.counted for sweep in shown.sweeps] == [False, False, True, True]


def test_review_shows_what_was_known_then(recorded, track) -> None:
    first_belief = next(record.seq for record in recorded if record.event.kind == "belief_updated")
    then = at_end(recorded, track, first_belief)
    assert then.seq == first_belief
    assert [sweep.place_number for sweep in then.sweeps] == [1]
    assert then.next_places == ()
    at_s = recorded[first_belief - 1].at_utc.timestamp()
    assert len(then.path) == sum(point.at_s <= at_s for point in track)
    assert known(then.vehicle).y == pytest.approx(then.path[-1][1])
    assert [mark.emitter_id for mark in then.estimates] == [FIRST_EMITTER]


def test_before_the_start_there_is_the_area_only(recorded) -> None:
    draft = at_end(recorded, (), 1)
    assert draft.home is None
    assert draft.sweeps == draft.candidates == ()
    west, south, east, north = draft.area.bounds
    assert (west + east, south + north) == pytest.approx((0, 0), abs=0.1)


def test_nothing_is_drafted_no_story() -> None:
    assert read_story([]) is None


def test_a_mission_that_is_over_has_no_next_place(recorded) -> None:
    ended = more(recorded, MissionEnded(outcome="localized", reason=Localized(), mission_time_s=100.0))
    shown = at_end(ended)
    assert shown.next_places == ()
    assert shown.candidates == ()


def test_track_points_without_a_number_are_left_out(recorded, track) -> None:
    from dataclasses import replace

    broken = [replace(track[0], lat_deg=float("nan")), *track[1:5]]
    assert len(at_end(recorded, broken).path) == 4
