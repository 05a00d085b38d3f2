from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.frame import LocalFrame
from hardware.readings import Place
from hardware.sim.autopilot.geodesy import HomeFrame


@given(st.floats(-80, 80), st.floats(-179, 179), st.floats(-2000, 2000), st.floats(-2000, 2000))
def test_metres_survive_the_way_to_degrees_and_back(lat: float, lon: float, north: float, east: float) -> None:
    home = HomeFrame(lat, lon, 100.0)

    assert home.to_local(*home.to_geo(north, east)) == pytest.approx((north, east), abs=1e-5)


@given(st.floats(-70, 70), st.floats(-179, 179), st.floats(-1000, 1000), st.floats(-1000, 1000))
def test_it_agrees_with_the_ellipsoids_tangent_plane(lat: float, lon: float, north: float, east: float) -> None:
    place = Place(*HomeFrame(lat, lon, 0.0).to_geo(north, east))
    plane_east, plane_north = LocalFrame(Place(lat, lon)).to_enu(place)

    assert math.hypot(plane_east - east, plane_north - north) < 0.5


@pytest.mark.parametrize("home", [(90.0, 0.0, 0.0), (0.0, 181.0, 0.0), (float("nan"), 0.0, 0.0), (0, 0, float("inf"))])
def test_a_home_that_is_nowhere_is_refused(home: tuple[float, float, float]) -> None:
    with pytest.raises(ValueError, match="no usable place"):
        HomeFrame(*home)
