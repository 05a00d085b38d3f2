from __future__ import annotations

import pytest
from refusals import near, refusing
from shapely import Point

from backend.reasons import search as reasons
from backend.search.area import LARGEST_EXTENT_M, MOST_VERTICES, centre_of, check_reach, fence, region, target_area
from backend.search.errors import MissionInputError
from backend.spec import Area, FlightSpec, MissionSpec, MultiPolygon, Polygon
from hardware.frame import LocalFrame
from hardware.readings import Place
from planner.geometry import region_area
from planner.reason import Reason

FRAME = LocalFrame(Place(50.0, 7.0))


def ring(*enu: tuple[float, float]) -> list[tuple[float, float]]:
    places = [FRAME.to_geo(x, y) for x, y in (*enu, enu[0])]
    return [(p.lon, p.lat) for p in places]


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


CROSSED = ring((0, 0), (99, 99), (99, 0), (0, 99))


@pytest.mark.parametrize(
    ("area", "reason", "field"),
    [
        (Polygon(coordinates=[]), reasons.AreaEmpty("area"), "area"),
        (MultiPolygon(coordinates=[]), reasons.AreaEmpty("area"), "area"),
        (Polygon(coordinates=[[]]), reasons.TooFewCorners("area"), "area.coordinates.0"),
        (Polygon(coordinates=[ring((0, 0), (9, 9))]), reasons.TooFewCorners("area"), "area.coordinates.0"),
        (Polygon(coordinates=[CROSSED]), reasons.OutlineUnusable("area", "crosses_itself"), "area.coordinates"),
        (
            MultiPolygon(coordinates=[[square(50)], [CROSSED]]),
            reasons.OutlineUnusable("area", "crosses_itself"),
            "area.coordinates.1",
        ),
        (
            Polygon(coordinates=[square(100), square(10, 500)]),
            reasons.OutlineUnusable("area", "hole_outside"),
            "area.coordinates",
        ),
        (
            Polygon(coordinates=[[(7.0 + i * 1e-6, 50.0 + (i % 2)) for i in range(2000)]]),
            reasons.TooManyCorners("area", MOST_VERTICES),
            "area",
        ),
    ],
)
def test_unusable_areas_are_refused_with_reason_and_field(area: Area, reason: Reason, field: str) -> None:
    with pytest.raises(MissionInputError) as refused:
        target_area(mission(area), FRAME)
    assert refused.value.reason == reason
    assert refused.value.field == field


def test_an_area_too_small_or_too_wide_is_refused_with_its_size() -> None:
    with pytest.raises(MissionInputError) as small:
        target_area(mission(Polygon(coordinates=[square(5)])), FRAME)
    assert small.value.reason == reasons.AreaTooSmall(near(25.0), 100.0)
    with pytest.raises(MissionInputError) as wide:
        target_area(mission(Polygon(coordinates=[square(LARGEST_EXTENT_M + 100)])), FRAME)
    assert wide.value.reason == reasons.AreaTooWide(near(LARGEST_EXTENT_M + 100), LARGEST_EXTENT_M)
    assert small.value.field == wide.value.field == "area.coordinates"


def test_an_area_far_from_the_vehicle_is_refused() -> None:
    check_reach(target_area(mission(Polygon(coordinates=[square(100, 4_000)])), FRAME))
    far = target_area(mission(Polygon(coordinates=[square(100, 6_000)])), FRAME)
    with refusing(reasons.AreaTooFar(near(6_000)), MissionInputError):
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
    assert refused.value.reason == reasons.OutlineUnusable("fence", "crosses_itself")
    assert refused.value.field == "flight.fence.coordinates"


def test_the_middle_of_an_area() -> None:
    middle = centre_of(Polygon(coordinates=[[(7.0, 50.0), (7.2, 50.0), (7.2, 50.1), (7.0, 50.1)]]))
    assert (middle.lat, middle.lon) == pytest.approx((50.05, 7.1))
    with refusing(reasons.AreaEmpty("area"), MissionInputError):
        centre_of(Polygon(coordinates=[]))


def test_the_middle_of_an_area_across_the_antimeridian_lies_in_it() -> None:
    middle = centre_of(Polygon(coordinates=[[(179.99, -17.0), (-179.97, -17.0), (-179.97, -16.9), (179.99, -16.9)]]))
    assert (middle.lon, middle.lat) == (pytest.approx(-179.99), pytest.approx(-16.95))
