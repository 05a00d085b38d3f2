"""Coverage is counted in tiles that are there."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from narrowing import known
from shapely.geometry import shape

from backend.maps.coverage import TileSet, coverage, metres_per_pixel, tiles_over, to_plane
from backend.maps.refusal import MapRefused
from backend.reasons.maps import AreaOnMaps
from backend.spec import MultiPolygon, Polygon


def rectangle(west: float, south: float, east: float, north: float) -> Polygon:
    return Polygon(coordinates=[[(west, south), (east, south), (east, north), (west, north), (west, south)]])


AREA = rectangle(7.20, 50.62, 7.21, 50.63)


def everything(name: str = "all", zooms: tuple[int, int] = (12, 16)) -> TileSet:
    return TileSet(name, name, *zooms, lambda z, x, y: True)


def test_a_full_map_covers_everything_at_every_zoom() -> None:
    found = coverage(AREA, [everything()])
    assert found.covered
    assert found.fraction == 1.0
    assert found.missing is None
    (only,) = found.maps
    assert [zoom.fraction for zoom in only.zooms] == [1.0] * 5
    assert only.full_to_zoom == 16
    assert only.metres_per_pixel == pytest.approx(metres_per_pixel(16, 50.625), rel=1e-6)


def test_a_set_with_an_empty_polygon_is_refused_in_words() -> None:
    empty = MultiPolygon(coordinates=[[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]], []])
    with pytest.raises(MapRefused, match="three different corners"):
        to_plane(empty)


def test_resolution_at_the_equator_is_the_known_one() -> None:
    assert metres_per_pixel(0, 0.0) == pytest.approx(156_543.03, abs=0.01)
    assert metres_per_pixel(16, 60.0) == pytest.approx(156_543.03 / 2**17, rel=1e-6)


def test_an_area_across_180_degrees_is_covered_by_the_tiles_on_both_sides() -> None:
    """It was taken for one around the whole earth."""
    for area in (rectangle(179.995, -16.81, -179.995, -16.8), rectangle(-179.995, -16.81, 179.995, -16.8)):
        asked: set[int] = set()

        def on_both_sides(zoom: int, x: int, y: int, asked: set[int] = asked) -> bool:
            asked.add(x)
            return x in (0, 2**zoom - 1)

        found = coverage(area, [TileSet("both", "both", 12, 14, on_both_sides)])
        assert found.covered
        assert asked == {0, 2**12 - 1, 2**13 - 1, 2**14 - 1}


def test_what_a_map_misses_beyond_180_degrees_has_longitudes_on_earth() -> None:
    area = rectangle(179.995, -16.81, -179.995, -16.8)
    found = coverage(area, [TileSet("west", "west", 12, 14, lambda z, x, y: x == 2**z - 1)])
    assert found.fraction == pytest.approx(0.5, abs=1e-6)
    lon = [corner[0] for polygon in known(found.missing).coordinates for ring in polygon for corner in ring]
    assert all(abs(abs(one) - 180.0) <= 0.005 + 1e-6 for one in lon)


def test_a_map_of_the_western_half_misses_the_eastern() -> None:
    plane = to_plane(AREA)
    columns = sorted({int(x) for x, _ in known(tiles_over(plane, 16))})
    west = columns[: len(columns) // 2]
    found = coverage(AREA, [TileSet("w", "west", 16, 16, lambda z, x, y: x in west)])
    assert not found.covered
    assert 0.1 < found.fraction < 0.9
    missing = shape(known(found.missing).model_dump())
    whole = shape(AREA.model_dump())
    assert missing.area / whole.area == pytest.approx(1 - found.fraction, abs=1e-3)
    assert missing.bounds[2] == pytest.approx(7.21, abs=1e-6)
    assert missing.bounds[0] > 7.201
    assert found.summary == AreaOnMaps("partly", math.floor(100 * found.fraction))


def test_two_halves_make_a_whole() -> None:
    columns = sorted({int(x) for x, _ in known(tiles_over(to_plane(AREA), 16))})
    west = columns[: len(columns) // 2]
    halves = [
        TileSet("w", "west", 16, 16, lambda z, x, y: x in west),
        TileSet("e", "east", 16, 16, lambda z, x, y: x not in west),
    ]
    found = coverage(AREA, halves)
    assert found.covered
    assert all(entry.full_to_zoom is None for entry in found.maps)
    assert found.summary == AreaOnMaps("whole", 100.0)


def test_a_coarse_map_is_no_cover() -> None:
    found = coverage(AREA, [everything(zooms=(0, 10))])
    assert not found.covered
    assert found.maps[0].full_to_zoom == 10
    assert found.summary == AreaOnMaps("not_finely", 0.0)


def test_without_maps_it_says_so() -> None:
    found = coverage(AREA, [])
    assert (found.covered, found.fraction) == (False, 0.0)
    assert found.summary == AreaOnMaps("no_map", 0.0)


def test_an_area_with_a_hole_needs_nothing_inside_the_hole() -> None:
    outer, hole = rectangle(7.0, 50.0, 7.4, 50.4), rectangle(7.1, 50.1, 7.3, 50.3)
    ring = Polygon(coordinates=[outer.coordinates[0], hole.coordinates[0][::-1]])
    around, whole = known(tiles_over(to_plane(ring), 14)), known(tiles_over(to_plane(outer), 14))
    assert len(around) < len(whole)


def test_zooms_that_need_too_many_tiles_are_not_looked_at() -> None:
    found = coverage(rectangle(6.0, 50.0, 8.0, 52.0), [everything(zooms=(5, 20))])
    assert found.maps[0].zooms[-1].zoom < 14
    assert max(zoom.tiles_needed for zoom in found.maps[0].zooms) <= 2048


@pytest.mark.parametrize(
    ("area", "words"),
    [
        (Polygon(coordinates=[]), "empty"),
        (Polygon(coordinates=[[(7.0, 50.0), (7.1, 50.0)]]), "three different corners"),
        (Polygon(coordinates=[[(0, 0), (1, 1), (1, 0), (0, 1), (0, 0)]]), "crosses itself"),
        (rectangle(0, 84, 1, 89), "85 degrees"),
        (MultiPolygon(coordinates=[]), "empty"),
    ],
)
def test_areas_that_make_no_sense_are_refused(area: Polygon, words: str) -> None:
    with pytest.raises(MapRefused, match=words):
        coverage(area, [])


@settings(max_examples=50, deadline=None)
@given(
    st.floats(-170, 170),
    st.floats(-75, 75),
    st.floats(0.001, 0.05),
    st.integers(0, 2**31),
)
def test_shown_and_missing_make_the_whole_area(west: float, south: float, size: float, seed: int) -> None:
    area = rectangle(west, south, west + size, south + size)
    found = coverage(area, [TileSet("m", "m", 13, 16, lambda z, x, y: (x * 7 + y * 13 + seed) % 3 > 0)])
    for entry in found.maps[0].zooms:
        assert 0 <= entry.fraction <= 1
        assert 0 <= entry.tiles_present <= entry.tiles_needed
        assert (entry.fraction == 1.0) >= (entry.tiles_present == entry.tiles_needed)
