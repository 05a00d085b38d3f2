"""A region covers a place or not, wherever on Earth it lies."""

from __future__ import annotations

import pytest

from backend.search.covering import covers
from backend.spec import Area, MultiPolygon, Place, Polygon


def square(lon: float, lat: float, width: float = 0.01) -> list[tuple[float, float]]:
    def on_earth(lon: float) -> float:
        return (lon + 180.0) % 360.0 - 180.0

    east, north = on_earth(lon + width), lat + width
    return [(lon, lat), (east, lat), (east, north), (lon, north), (lon, lat)]


@pytest.mark.parametrize("lon", [7.2, 179.995, -180.0, 179.99])
def test_a_place_is_inside_or_outside_of_it(lon: float) -> None:
    region = Polygon(coordinates=[square(lon, 50.0)])
    for off, inside in ((0.004, True), (0.006, True), (-0.001, False), (0.011, False), (180.0, False)):
        at = (lon + off + 180.0) % 360.0 - 180.0
        assert covers(region, Place(lat=50.005, lon=at)) == inside, off
    assert not covers(region, Place(lat=50.02, lon=lon))


def test_a_hole_and_parts_on_both_sides_of_the_antimeridian() -> None:
    region = MultiPolygon(coordinates=[[square(179.98, 0.0, 0.04), square(179.995, 0.01)], [square(-179.97, 0.0)]])
    assert [covers(region, Place(lat=0.015, lon=lon)) for lon in (179.985, 180.0, -180.0, -179.985)] == [
        True,
        False,
        False,
        True,
    ]
    assert covers(region, Place(lat=0.005, lon=-179.965))


@pytest.mark.parametrize(
    "region",
    [
        Polygon(coordinates=[]),
        Polygon(coordinates=[[]]),
        Polygon(coordinates=[[(7.2, 50.6), (7.2, 50.6)]]),
        MultiPolygon(coordinates=[]),
    ],
)
def test_what_is_no_region_covers_nothing(region: Area) -> None:
    assert not covers(region, Place(lat=50.6, lon=7.2))
