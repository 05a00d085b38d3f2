from __future__ import annotations

import pytest
from ground import AREA, FRAME, HOME

from backend.search.task import search_task
from backend.spec import EmitterSpec, FlightSpec, MissionSpec

SPEC = MissionSpec(
    name="m",
    area=AREA,
    emitters=[EmitterSpec(emitter_id="b"), EmitterSpec(emitter_id="a")],
    flight=FlightSpec(altitude_relative_m=35.0, fence_margin_m=10.0),
)


def test_there_is_one_localization_an_emitter_in_the_order_of_the_specification() -> None:
    task = search_task(SPEC, HOME, 100.0)
    assert list(task.emitters) == ["b", "a"]
    assert [made.emitter_id for made in task.emitters.values()] == ["b", "a"]
    assert task.first is task.emitters["b"]
    assert (task.home, task.mission) == (HOME, SPEC)


def test_everywhere_it_is_measured_at_the_flight_altitude_above_the_home() -> None:
    task = search_task(SPEC, HOME, 100.0)
    assert {task.altitude_at(FRAME.to_geo(x, 50.0)) for x in (0.0, 150.0, 300.0)} == {135.0}


def test_a_point_of_the_frame_is_a_place_on_the_ground() -> None:
    task = search_task(SPEC, HOME, 100.0)
    assert task.frame.to_enu(task.place(120.0, 40.0)) == pytest.approx((120.0, 40.0), abs=1e-3)
