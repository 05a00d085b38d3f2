"""What is exported is where it was drawn: turned the right way, and in two pieces across the antimeridian."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from narrowing import a
from shapely import Polygon, get_parts
from shapely.geometry import shape
from shapely.geometry.base import BaseGeometry

from backend import spec
from backend.wire.export_geometry import area_geometry, path_geometry


def rounded(lon: float) -> float:
    """In [-180, 180)."""
    return (lon + 180.0) % 360.0 - 180.0


def parts_of(found: BaseGeometry) -> list[Polygon]:
    return [a(Polygon, part) for part in get_parts(found)]


def rectangle(west: float, south: float, width: float, height: float, *, clockwise: bool = False) -> list:
    east, north = west + width, south + height
    ring = [(west, south), (east, south), (east, north), (west, north), (west, south)]
    return [(rounded(lon), lat) for lon, lat in (ring[::-1] if clockwise else ring)]


@given(
    west=st.one_of(st.floats(-180, 179.99), st.floats(179.9, 179.9999), st.sampled_from([179.99, -180.0, 180.0])),
    south=st.floats(-80, 80),
    clockwise=st.booleans(),
    multi=st.booleans(),
)
def test_an_area_is_valid_counter_clockwise_and_as_large_as_it_was(west, south, clockwise, multi) -> None:
    ring = rectangle(west, south, 0.01, 0.02, clockwise=clockwise)
    area = spec.MultiPolygon(coordinates=[[ring]]) if multi else spec.Polygon(coordinates=[ring])
    found = shape(area_geometry(area))
    assert found.is_valid
    assert found.area == pytest.approx(0.01 * 0.02)
    for part in parts_of(found):
        lon_min, _, lon_max, _ = part.bounds
        assert -180.0 <= lon_min < lon_max <= 180.0
        assert lon_max - lon_min < 0.011
        assert part.exterior.is_ccw


def test_an_area_across_the_antimeridian_is_two_that_touch_it() -> None:
    ring = rectangle(179.995, 50.0, 0.01, 0.01)
    found = area_geometry(spec.Polygon(coordinates=[ring]))
    assert found["type"] == "MultiPolygon"
    assert sorted(shape(found).bounds) == pytest.approx([-180.0, 50.0, 50.01, 180.0])


def test_a_hole_is_clockwise_and_cut_with_its_area() -> None:
    for west in (7.2, 179.995):
        outer, hole = rectangle(west, 50.0, 0.01, 0.01, clockwise=True), rectangle(west + 0.004, 50.004, 0.002, 0.002)
        found = shape(area_geometry(spec.Polygon(coordinates=[outer, hole])))
        assert found.area == pytest.approx(0.01**2 - 0.002**2)
        parts = parts_of(found)
        assert not any(inner.is_ccw for part in parts for inner in part.interiors)
        assert all(part.exterior.is_ccw for part in parts)


def test_an_area_elsewhere_keeps_its_corners() -> None:
    ring = rectangle(7.2, 50.62, 0.01, 0.01)
    area = spec.Polygon(coordinates=[ring])
    assert area_geometry(area) == {"type": "Polygon", "coordinates": [[list(corner) for corner in ring]]}


@pytest.mark.parametrize("rings", [[], [[]], [[(179.9, 50.0), (-179.9, 50.0)]], [[(7.2, 50.6), (7.2, 50.6)]]])
def test_what_is_no_area_is_told_as_it_is(rings) -> None:
    told = area_geometry(spec.Polygon(coordinates=rings))["coordinates"]
    assert {tuple(point) for ring in told for point in ring} == {point for ring in rings for point in ring}


def test_an_area_around_the_pole_is_told_as_it_is() -> None:
    ring = [(0.0, 89.99), (120.0, 89.99), (-120.0, 89.99), (0.0, 89.99)]
    assert area_geometry(spec.Polygon(coordinates=[ring]))["coordinates"] == [[list(point) for point in ring]]


def test_a_path_across_the_antimeridian_is_two() -> None:
    found = path_geometry([[179.998, 50.0], [-179.998, 50.002], [-179.997, 50.002]])
    assert found["type"] == "MultiLineString"
    (first, last), (begin, *rest) = found["coordinates"]
    assert (first, last) == ([179.998, 50.0], pytest.approx([180.0, 50.001]))
    assert begin == pytest.approx([-180.0, 50.001])
    assert rest == [[-179.998, 50.002], [-179.997, 50.002]]


@pytest.mark.parametrize("there", [180.0, -180.0, -179.9])
@pytest.mark.parametrize("here", [180.0, 179.9, -180.0])
def test_a_path_on_the_antimeridian_has_no_piece_without_length(here, there) -> None:
    found = shape(path_geometry([[here, 50.1], [there, 50.0]]))
    assert found.is_valid
    assert found.length == pytest.approx(math.hypot((there - here) % 360.0, 0.1))


def test_a_path_elsewhere_is_one_line() -> None:
    points = [[7.2, 50.6], [7.2, 50.6], [7.3, 50.6]]
    assert path_geometry(points) == {"type": "LineString", "coordinates": points}
