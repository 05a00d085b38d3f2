"""The mission that is suggested to everybody: flown by our own planner, whose table nobody has to wait for."""

import math
from dataclasses import replace

import pytest

from backend.api.suggestion import suggested_mission, with_errors_said
from backend.search.forecast import forecast, preview
from backend.search.localization import localization
from backend.search.planning import next_place_together
from backend.spec import SensorSpec
from hardware.readings import Place
from planner.options import CROSSFIX, FIELD
from planner.policy.value_table import key_of, program_for, shipped
from planner.reasons import PlannedMeanwhile

HOME = Place(lat=50.6, lon=7.2)


def test_it_is_flown_by_the_planner_of_the_studies():
    assert suggested_mission(HOME).planner.options == CROSSFIX


def test_a_specification_that_names_no_planner_means_the_one_it_was_flown_with():
    spec = suggested_mission(HOME)
    stored = spec.model_dump(exclude={"planner"})
    assert type(spec).model_validate(stored).planner.options == FIELD


def test_its_table_comes_with_the_package_so_that_no_first_plan_is_made_meanwhile():
    task = localization(suggested_mission(HOME), HOME)
    assert program_for(task.problem) is shipped()[key_of(task.problem)]
    assert not isinstance(preview(task, HOME, threads=1).reason, PlannedMeanwhile)


def test_it_turns_first_in_its_area_and_not_beyond_the_far_end():
    """Home lies on its southern edge; flown across first, missions took half a minute longer."""
    task = localization(suggested_mission(HOME), HOME)
    first = preview(task, HOME, threads=1)
    east, north = task.frame.to_enu(first.first_place)
    assert math.hypot(east, north) < 110.0
    assert first.mean_s is not None
    beyond = forecast(task, (), HOME, task.place(0.0, 246.0), lambda _place, _way: ())
    assert beyond.mean_s is not None
    assert beyond.mean_s - first.mean_s > 30.0


@pytest.mark.parametrize("sigma_deg", [1.6, 2.5, 5.0, 9.0, 15.0, 23.0])
@pytest.mark.parametrize("measurement_time", [12.0, 30.0, 80.0])
def test_what_a_flight_finds_of_its_sensor_needs_no_other_table(sigma_deg, measurement_time):
    problem = localization(suggested_mission(HOME), HOME).problem
    found = replace(problem, sigma=math.radians(sigma_deg), measurement_time=measurement_time)
    assert program_for(found) in shipped().values()


def test_several_emitters_are_planned_for_with_it():
    spec = suggested_mission(HOME)
    first = spec.emitters[0]
    second = first.model_copy(update={"emitter_id": "second", "frequency_hz": first.frequency_hz + 1e5})
    spec = spec.model_copy(update={"emitters": [first, second]})
    tasks = [localization(spec, HOME, emitter.emitter_id) for emitter in spec.emitters]
    chosen = next_place_together([(task, ()) for task in tasks], (0.0, 0.0), 1, (), threads=1)
    assert chosen.expected_time_s is not None
    assert chosen.expected_time_s > 2 * spec.sensor.measurement_time_s


def test_what_a_request_says_of_errors_stands_and_what_it_does_not_is_estimated_by_all_emitters():
    assert suggested_mission(HOME).sensor.shared_errors
    spec = suggested_mission(HOME)
    for said in ({}, {"bearing_errors": "independent"}, {"shared_errors": False}, {"sweep_evidence": "peak"}):
        asked = spec.model_copy(update={"sensor": SensorSpec.model_validate(said)})
        found = with_errors_said(asked).sensor
        assert found.bearing_errors == said.get("bearing_errors", "joint")
        assert found.shared_errors == said.get("shared_errors", True)
        assert found.sweep_evidence == said.get("sweep_evidence", "whole")
