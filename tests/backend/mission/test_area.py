from __future__ import annotations

import pytest
from shapely import Point

from backend.mission.area import LARGEST_EXTENT_M, centre_of, check_reach, fence, region, target_area
from backend.mission.errors import MissionInputError
from backend.spec import Area, FlightSpec, MissionSpec, MultiPolygon, Polygon
from hardware.frame import LocalFrame
from hardware.readings import GeoPoint
from planner.geometry import region_area

FRAME = LocalFrame(GeoPoint(50.0, 7.0))


def ring(*enu: tuple[float, float]) -> list[tuple[float, float]]:
    places = [FRAME.to_geo(x, y) for x, y in (*enu, enu[0])]
    return [(p.lon_deg, p.lat_deg) for p in places]


def square(size: float, x: float = 0.0, y: float = 0.0) -> list[tuple[float, float]]:
    return ring((x, y), (x + size, y), (x + size, y + size), (x, y + size))


def mission(area: Area, **flight: object) -> MissionSpec:
    return MissionSpec(name="m", area=area, flight=FlightSpec(**flight))  # type: ignore[arg-type]


def test_a_square_keeps_its_size_and_orientation_does_not_matter() -> None:
    for corners in (square(100), square(100)[::-1]):
        area = target_area(mission(Polygon(coordinates=[corners])), FRAME)
        assert area.area == pytest.approx(10_000, rel=1e-3)


def test_an_unclosed_ring_is_read_like_a_closed_one() -> None:
    assert target_area(mission(Polygon(coordinates=[square(100)[:-1]])), FRAME).area == pytest.approx(10_000, rel=1e-3)


def test_overlapping_polygons_are_united_and_holes_stay_holes() -> None:
    two = target_area(mission(MultiPolygon(coordinates=[[square(100)], [square(100, 50)]])), FRAME)
    assert two.area == pytest.approx(15_000, rel=1e-3)
    holed = target_area(mission(Polygon(coordinates=[square(100), square(20, 40, 40)])), FRAME)
    assert holed.area == pytest.approx(10_000 - 400, rel=1e-3)
    assert region_area(region(holed)) == pytest.approx(holed.area, rel=1e-9)


@pytest.mark.parametrize(
    ("area", "says", "field"),
    [
        (Polygon(coordinates=[]), "empty", "area"),
        (MultiPolygon(coordinates=[]), "empty", "area"),
        (Polygon(coordinates=[[]]), "fewer than three", "area.coordinates.0"),
        (Polygon(coordinates=[ring((0, 0), (9, 9))]), "fewer than three", "area.coordinates.0"),
        (Polygon(coordinates=[ring((0, 0), (99, 99), (99, 0), (0, 99))]), "crosses itself", "area.coordinates"),
        (
            MultiPolygon(coordinates=[[square(50)], [ring((0, 0), (99, 99), (99, 0), (0, 99))]]),
            "crosses itself",
            "area.coordinates.1",
        ),
        (Polygon(coordinates=[square(100), square(10, 500)]), "hole", "area.coordinates"),
        (Polygon(coordinates=[square(5)]), "only 25 m2", "area.coordinates"),
        (Polygon(coordinates=[square(LARGEST_EXTENT_M + 100)]), "km wide", "area.coordinates"),
        (Polygon(coordinates=[[(7.0 + i * 1e-6, 50.0 + (i % 2)) for i in range(2000)]]), "corners", "area"),
    ],
)
def test_unusable_areas_are_refused_with_reason_remedy_and_field(area: Area, says: str, field: str) -> None:
    with pytest.raises(MissionInputError, match=says) as refused:
        target_area(mission(area), FRAME)
    assert refused.value.field == field
    assert refused.value.remedy


def test_an_area_far_from_the_vehicle_is_refused() -> None:
    near = target_area(mission(Polygon(coordinates=[square(100, 4_000)])), FRAME)
    check_reach(near)
    far = target_area(mission(Polygon(coordinates=[square(100, 6_000)])), FRAME)
    with pytest.raises(MissionInputError, match=r"6\.0 km away"):
        check_reach(far)


def test_the_fence_is_the_area_with_its_margin_unless_it_is_drawn() -> None:
    spec = mission(Polygon(coordinates=[square(100)]), fence_margin_m=30.0)
    around = fence(spec, target_area(spec, FRAME), FRAME)
    assert around.contains(Point(-29, 50))
    assert not around.contains(Point(-31, 50))
    drawn = mission(Polygon(coordinates=[square(100)]), fence=Polygon(coordinates=[square(300)]))
    assert fence(drawn, target_area(drawn, FRAME), FRAME).area == pytest.approx(90_000, rel=1e-3)
    crossed = mission(
        Polygon(coordinates=[square(100)]), fence=Polygon(coordinates=[ring((0, 0), (99, 99), (99, 0), (0, 99))])
    )
    with pytest.raises(MissionInputError) as refused:
        fence(crossed, target_area(crossed, FRAME), FRAME)
    assert refused.value.field == "flight.fence.coordinates"


def test_the_middle_of_an_area() -> None:
    middle = centre_of(Polygon(coordinates=[[(7.0, 50.0), (7.2, 50.0), (7.2, 50.1), (7.0, 50.1)]]))
    assert (middle.lat_deg, middle.lon_deg) == pytest.approx((50.05, 7.1))
    with pytest.raises(MissionInputError):
        centre_of(Polygon(coordinates=[]))
