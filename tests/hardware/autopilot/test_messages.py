from __future__ import annotations

import math

import pytest

from hardware.autopilot.ground import distance_m
from hardware.autopilot.messages import message_interval, pause, reposition
from hardware.frame import LocalFrame
from hardware.readings import Place

PLACE = Place(47.3977419, -8.5455938)


@pytest.mark.parametrize(
    ("yaw", "wire"), [(0.0, 0.0), (90.0, math.pi / 2), (270.0, -math.pi / 2), (450.0, math.pi / 2)]
)
def test_yaw_is_radians_on_the_wire(yaw: float, wire: float) -> None:
    assert reposition(PLACE, 500.0, 5.0, yaw).fields["param4"] == pytest.approx(wire)


def test_a_place_keeps_its_centimetre_and_no_yaw_is_nan() -> None:
    fields = reposition(PLACE, 500.25, None, None).fields

    assert (fields["x"], fields["y"], fields["z"]) == (473977419, -85455938, 500.25)
    assert fields["param4"] is None
    assert fields["param1"] == -1.0
    assert fields["param2"] == 0.0  # with the change-mode flag it would take the vehicle from a pilot


def test_a_pause_names_no_place_no_height_and_no_yaw() -> None:
    fields = pause().fields

    assert [fields[f"param{i}"] for i in (4, 5, 6, 7)] == [None] * 4


def test_a_rate_becomes_microseconds() -> None:
    assert message_interval(30, 20.0).fields["param2"] == 50_000.0


@pytest.mark.parametrize(("east", "north"), [(100.0, 0.0), (0.0, -250.0), (-70.0, 70.0)])
def test_short_distances_are_good_to_half_a_percent(east: float, north: float) -> None:
    away = LocalFrame(PLACE).to_geo(east, north)

    assert distance_m(PLACE, away) == pytest.approx(math.hypot(east, north), rel=5e-3)
    assert distance_m(Place(10.0, 179.9999), Place(10.0, -179.9999)) < 30.0
