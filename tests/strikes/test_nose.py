"""The judge of strikes at a turning nose is right about what the record says."""

from __future__ import annotations

import math

import pytest

from hardware.autopilot.messages import CONDITION_YAW, REPOSITION, SET_MODE
from tests.strikes.nose import came_to_rest, mode_ordered, rate_deg_s, steered_after, stop_ordered, way_home
from tests.strikes.proxy import ATTITUDE, COMMAND_INT, COMMAND_LONG, Passed


def nose(at_s: float, deg_s: float) -> Passed:
    return Passed(at_s, "from", ATTITUDE, {"yawspeed": math.radians(deg_s)})


def order(at_s: float, number: int, message: int = COMMAND_LONG, custom: tuple[float, float] = (0.0, 0.0)) -> Passed:
    return Passed(at_s, "to", message, {"command": number, "param2": custom[0], "param3": custom[1]})


def test_a_nose_that_brakes_is_still_from_the_first_look_that_sees_it_so() -> None:
    record = [nose(10.0 + 0.1 * step, max(30.0 - 10.0 * step, 0.0)) for step in range(20)]

    still_s, turned = came_to_rest(record, 10.0, 12.0)

    assert still_s == pytest.approx(0.3)
    assert turned == pytest.approx(2.0 + 1.0)


def test_a_nose_that_turns_to_the_end_turns_on() -> None:
    record = [nose(10.0 + 0.1 * step, 30.0) for step in range(20)]

    assert came_to_rest(record, 10.0, 12.0)[0] is None


def test_a_nose_that_begins_again_was_not_at_rest_before() -> None:
    record = [nose(10.0, 30.0), nose(10.1, 0.0), nose(11.0, -20.0), nose(11.1, 0.0)]

    assert came_to_rest(record, 10.0, 12.0)[0] == pytest.approx(1.1)


def test_places_and_yaws_steer_and_a_pause_or_a_mode_stops() -> None:
    record = [
        order(10.0, REPOSITION, COMMAND_INT),
        order(10.5, REPOSITION),
        order(11.0, CONDITION_YAW),
        order(12.0, SET_MODE, custom=(4.0, 5.0)),
        Passed(12.5, "pilot", COMMAND_LONG, {"command": SET_MODE, "param2": 3.0, "param3": 0.0}),
    ]

    assert stop_ordered(record) == 10.5
    assert mode_ordered(record, (4.0, 5.0)) == 12.0
    assert mode_ordered(record, (3.0, 0.0)) is None
    assert (steered_after(record, 10.5), steered_after(record, 11.0)) == (1, 0)


def test_a_way_home_is_a_place_alone() -> None:
    turn = Passed(10.0, "to", COMMAND_INT, {"command": REPOSITION, "param4": 1.5})
    home = Passed(11.0, "to", COMMAND_INT, {"command": REPOSITION, "param4": math.nan})

    assert way_home([turn]) is None
    assert way_home([turn, home]) == 11.0


def test_the_rate_is_the_one_told_last() -> None:
    assert rate_deg_s([]) == 0.0
    assert rate_deg_s([nose(1.0, 5.0), nose(2.0, -31.0), order(3.0, CONDITION_YAW)]) == pytest.approx(-31.0)
