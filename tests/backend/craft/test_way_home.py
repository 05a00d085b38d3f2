"""The way home leads around what may not be flown over, wherever the vehicle is."""

from __future__ import annotations

import math

import pytest
from airspace import airspace
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, Point, Polygon, box

from backend.craft.way_home import ABOVE_HOME_M, legs_home, way_home
from backend.search.area import EDGE_TOLERANCE_M

FENCE = box(-60, -60, 400, 300)
WALL = box(100, -60, 140, 200)
POCKET = Polygon([(-20, -20), (60, -20), (60, 20), (-20, 20), (-20, 15), (50, 15), (50, -15), (-20, -15)])
"""Home lies in a U that is open to the west."""
BESIDE = box(1.0, -30.0, 20.0, 30.0)
"""Home lies a metre beside it: nearer than the planner flies."""


def flown(at: tuple[float, float], way: tuple[tuple[float, float], ...]) -> LineString:
    return LineString([at, *way])


@given(east=st.floats(-55, 395), north=st.floats(-55, 295))
@pytest.mark.parametrize("zones", [(WALL,), (POCKET, WALL), (BESIDE, WALL)])
def test_no_way_home_crosses_a_zone_from_anywhere_outside(
    zones: tuple[Polygon, ...], east: float, north: float
) -> None:
    if any(zone.distance(Point(east, north)) < 1e-3 for zone in zones):
        return
    way = way_home(airspace(FENCE, *zones), (east, north))
    assert way is not None
    assert way[-1] == (0.0, 0.0)
    path = flown((east, north), way)
    assert all(path.intersection(zone).length < 1e-6 for zone in zones)
    assert FENCE.buffer(EDGE_TOLERANCE_M).covers(path)


@given(east=st.floats(100, 140), north=st.floats(-55, 199))
def test_a_vehicle_inside_a_zone_leaves_it_by_the_nearest_border(east: float, north: float) -> None:
    way = way_home(airspace(FENCE, WALL), (east, north))
    assert way is not None
    inside = flown((east, north), way).intersection(WALL).length
    assert inside <= min(east - 100, 140 - east, 200 - north) + 1e-6


def test_a_home_that_is_walled_in_has_no_way() -> None:
    walls = (box(-30, -30, 30, -20), box(-30, 20, 30, 30), box(-30, -30, -20, 30), box(20, -30, 30, 30))
    zones = airspace(FENCE, *walls)
    assert way_home(zones, (200.0, 0.0)) is None
    assert legs_home(zones, (200.0, 0.0)) == ((-200.0, 0.0),)


def test_the_legs_are_those_of_the_way_and_none_above_home() -> None:
    zones = airspace(FENCE, WALL)
    legs = legs_home(zones, (300.0, 0.0))
    assert sum(math.hypot(*leg) for leg in legs) > 450.0
    assert sum(leg[0] for leg in legs) == pytest.approx(-300.0, abs=4.0)
    assert legs_home(zones, (0.5 * ABOVE_HOME_M, 0.0)) == ()
