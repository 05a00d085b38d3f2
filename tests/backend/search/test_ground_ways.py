"""Ways on foot around a river, over its bridge, through a maze; ways by car along roads only."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely.affinity
from shapely import LineString, MultiLineString, MultiPolygon, Polygon, box

from backend.reasons.ways import NoRoadNear, NoWayLeadsThere
from backend.search.errors import MissionInputError
from backend.search.ground_ways import Ground, Traced, along_roads, ground_of, on_foot
from hardware.frame import LocalFrame
from hardware.readings import Place

AROUND = box(-150.0, -150.0, 150.0, 150.0)
NOTHING = Polygon()
RIVER = Polygon([(-2000, -5), (2000, -5), (2000, 5), (-2000, 5)])
SOUTH, NORTH = (0.0, -100.0), (0.0, 100.0)


def ground(*, roads=(), paths=(), walls=(), waters=(), closed=NOTHING) -> Ground:
    return Ground(tuple(roads), tuple(paths), tuple(walls), tuple(waters), closed)


def length_to(laid, x: float, y: float) -> float:
    places = laid.ways.places
    nearest = places[np.argmin(np.hypot(*(places - (x, y)).T))]
    assert math.dist(nearest, (x, y)) < 30.0, f"{nearest} is the nearest to {x}, {y}"
    return float(laid.ways.to(nearest[None])[0]) - math.dist(nearest, (x, y))


def test_where_nothing_is_in_the_way_ways_are_straight() -> None:
    laid = on_foot(ground(), SOUTH, AROUND, 25.0)
    straight = np.hypot(*(laid.ways.places - np.array(SOUTH)).T)
    assert laid.ways.to(laid.ways.places) == pytest.approx(straight, abs=1e-6)
    assert laid.unreached == 0
    between = laid.ways.between(laid.ways.places)
    far = np.hypot(*(laid.ways.places[:, None] - laid.ways.places).transpose(2, 0, 1))
    assert (between >= far - 1e-6).all()
    assert (between <= 1.03 * far + 1e-6).all()


def test_a_river_without_a_bridge_leaves_the_other_shore_out_of_reach_and_says_so() -> None:
    laid = on_foot(ground(waters=[RIVER]), SOUTH, AROUND, 25.0)
    assert (laid.ways.places[:, 1] < -5.0).all()
    assert laid.unreached == pytest.approx(laid.places / 2, rel=0.2)


def test_a_bridge_is_gone_to_and_over() -> None:
    bridge = LineString([(80.0, -40.0), (80.0, 40.0)])
    laid = on_foot(ground(waters=[RIVER], paths=[bridge]), SOUTH, AROUND, 25.0)
    assert laid.unreached == 0
    around = 2 * math.dist(SOUTH, (80.0, -40.0)) + 80.0
    assert around * 0.85 < length_to(laid, *NORTH) < around * 1.15
    place = laid.ways.places[np.argmin(np.hypot(*(laid.ways.places - NORTH).T))]
    way = LineString(laid.ways.path(*place))
    crossing = shapely.intersection(way, RIVER)
    assert crossing.bounds[0] == pytest.approx(80.0, abs=1.0), "the river is crossed on the bridge"


@pytest.mark.parametrize("turn", [0.0, 17.0, 45.0, 63.4])
def test_a_wall_as_thin_as_a_line_is_not_slipped_through(turn: float) -> None:
    wall = shapely.affinity.rotate(LineString([(-3000, 3), (3000, 3)]), turn, origin=(0, 0))
    here = shapely.affinity.rotate(shapely.Point(0, -60), turn, origin=(0, 0))
    laid = on_foot(ground(walls=[wall]), (here.x, here.y), AROUND, 25.0)
    beyond = [LineString([(here.x, here.y), place]).crosses(wall) for place in laid.ways.places]
    assert not any(beyond)
    assert laid.unreached > 0.3 * laid.places


def test_a_wall_with_an_end_is_gone_around() -> None:
    wall = LineString([(-300.0, 0.0), (60.0, 0.0)])
    laid = on_foot(ground(walls=[wall]), SOUTH, AROUND, 25.0)
    around = 2 * math.dist(SOUTH, (60.0, 0.0))
    assert around * 0.88 < length_to(laid, *NORTH) < around * 1.15


def test_who_is_enclosed_gets_no_way() -> None:
    pen = shapely.Point(SOUTH).buffer(40.0).exterior
    with pytest.raises(MissionInputError) as refused:
        on_foot(ground(walls=[pen]), (0.0, 100.0), shapely.Point(SOUTH).buffer(20.0), 10.0)
    assert isinstance(refused.value.reason, NoWayLeadsThere)
    in_the_lake = box(-20, -120, 20, -80)
    with pytest.raises(MissionInputError):
        on_foot(ground(waters=[in_the_lake]), SOUTH, box(50, 50, 90, 90), 10.0)


def test_what_is_closed_is_kept_off_even_on_a_path() -> None:
    closed = box(-2000, -5, 2000, 5)
    path = LineString([(0.0, -40.0), (0.0, 40.0)])
    assert on_foot(ground(paths=[path], closed=closed), SOUTH, AROUND, 25.0).unreached > 0


ROADS = (
    LineString([(-400.0, -120.0), (100.0, -120.0), (100.0, 200.0)]),
    LineString([(-100.0, 60.0), (140.0, 60.0)]),
)


def test_a_car_keeps_to_roads_and_the_way_to_it_is_walked() -> None:
    # as the file's reader leaves them: with a position where they meet
    roads = list(shapely.get_parts(shapely.unary_union(ROADS)))
    laid = along_roads(ground(roads=roads), SOUTH, AROUND, 25.0, speed_m_s=9.0)
    network = MultiLineString(ROADS)
    assert max(network.distance(shapely.Point(place)) for place in laid.ways.places) < 0.5
    assert laid.unreached == 0
    to_the_crossing = 20.0 * 9.0 / 1.3 + 100.0 + 180.0
    assert length_to(laid, 100.0, 60.0) == pytest.approx(to_the_crossing, rel=0.15)


def test_a_car_on_an_island_of_roads_is_told_how_many_places_it_cannot_get_to() -> None:
    laid = along_roads(ground(roads=[ROADS[0], LineString([(-100.0, 60.0), (0.0, 60.0)])]), SOUTH, AROUND, 25.0, 9.0)
    assert 0 < laid.unreached < laid.places


def test_a_car_beside_two_roads_takes_the_one_that_leads_there() -> None:
    yard = LineString([(-5.0, -102.0), (5.0, -102.0)])
    laid = along_roads(ground(roads=[yard, ROADS[0]]), SOUTH, AROUND, 25.0, 9.0)
    assert length_to(laid, 100.0, 60.0) < 600.0


def test_a_car_on_a_long_straight_road_stands_on_it_however_large_the_search_is() -> None:
    road = LineString([(-6000.0, 0.0), (6000.0, 0.0)])
    around = box(-2500.0, -2500.0, 2500.0, 2500.0)
    for east in (-3000.0, -2800.0, -2600.0):
        assert along_roads(ground(roads=[road]), (east, 0.0), around, 5000.0, 9.0).ways.places.size


def test_no_road_is_near() -> None:
    with pytest.raises(MissionInputError) as refused:
        along_roads(ground(roads=[LineString([(0, 200), (100, 200)])]), SOUTH, AROUND, 25.0, 9.0)
    assert refused.value.reason == NoRoadNear(300.0, 150.0)
    river = box(-2000, -112, 2000, -108)
    with pytest.raises(MissionInputError):
        along_roads(ground(roads=[LineString([(0, -130), (100, -130)])], waters=[river]), SOUTH, AROUND, 25.0, 9.0)


def test_lines_and_areas_are_told_apart_in_the_frame_also_beyond_the_antimeridian() -> None:
    frame = LocalFrame(Place(-17.0, 179.9999))
    traced = [
        Traced("barrier", MultiPolygon([box(179.999, -17.001, 180.001, -16.999)])),
        Traced("road", MultiLineString([[(179.999, -17.0), (180.002, -17.0)]])),
    ]
    found = ground_of(traced, frame, NOTHING)
    (water,), (road,) = found.waters, found.roads
    assert (len(found.walls), len(found.paths)) == (0, 0)
    assert road.length == pytest.approx(320.0, rel=0.01)
    assert water.area == pytest.approx(213.0 * 221.0, rel=0.02)
