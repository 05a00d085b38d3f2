"""Ways around what may not be crossed."""

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st
from refusals import refusing
from scipy.sparse.csgraph import floyd_warshall

from planner import travel
from planner.reasons import NoWay
from planner.travel import lattice_distances, straight_suffices, travel_distances, travel_path, visibility_graph
from planner.types import LinearMotion, Problem


def rectangle(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


FENCE = rectangle(0, 0, 100, 100)
CORNER = np.array([[0, 0], [100, 0], [100, 40], [40, 40], [40, 100], [0, 100]], dtype=float)


def problem(flight_area=None, no_fly=()):
    area = None if flight_area is None else (flight_area,)
    return Problem((FENCE,), 0.1, 5.0, 1.0, LinearMotion(5.0), flight_area=area, no_fly=no_fly)


def way(problem, start, end):
    return travel_path(problem, np.array(start, float), np.array(end, float))


def length(path):
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def test_a_free_way_is_straight():
    assert way(problem(FENCE), (10, 10), (90, 80)).tolist() == [[10, 10], [90, 80]]


def test_a_no_fly_area_is_flown_around_on_the_shorter_side():
    path = way(problem(FENCE, (rectangle(40, 20, 60, 95),)), (10, 50), (90, 50))
    assert len(path) == 4
    assert path[1:3, 1].max() < 20.0
    assert length(path) == pytest.approx(length(np.array([[10, 50], [40, 20], [60, 20], [90, 50]])), rel=0.05)


def test_a_corner_of_a_non_convex_flight_area_is_turned_inside_it():
    path = way(problem(CORNER), (95, 35), (35, 95))
    assert len(path) == 3
    assert path[1, 0] < 40.0
    assert path[1, 1] < 40.0


def test_a_way_exactly_through_two_corners_is_no_way_through():
    path = way(problem(no_fly=(rectangle(40, 40, 60, 60),)), (0, 0), (100, 100))
    assert len(path) == 3


def test_a_wall_across_the_fence_leaves_no_way():
    walled = problem(FENCE, (rectangle(40, -10, 60, 110),))
    with refusing(NoWay(80.0)):
        way(walled, (10, 50), (90, 50))
    assert np.isinf(
        travel_distances(walled, visibility_graph(walled), np.array([10.0, 50.0]), np.array([[90.0, 50.0]]))
    )[0]


def test_a_platform_outside_its_fence_first_comes_back():
    path = way(problem(FENCE), (-20, 50), (50, 50))
    assert path[0].tolist() == [-20, 50]
    assert 0 < path[1, 0] < 3


place = st.tuples(st.floats(1, 99), st.floats(1, 99))


@given(place, place, st.floats(10, 40), st.floats(10, 40), st.floats(10, 45))
def test_a_way_stays_free_and_is_no_shorter_than_straight(a, b, x, y, size):
    block = rectangle(x, y, x + size, y + size)
    blocked = problem(FENCE, (block,))
    shape = shapely.Polygon(block)
    if shape.distance(shapely.Point(a)) < 0.1 or shape.distance(shapely.Point(b)) < 0.1:
        return
    path = travel_path(blocked, a, b)
    assert shapely.LineString(path).intersection(shape.buffer(-1e-6)).length == pytest.approx(0.0, abs=1e-6)
    assert length(path) >= np.hypot(a[0] - b[0], a[1] - b[1]) - 1e-9
    distance = travel_distances(blocked, visibility_graph(blocked), np.array(a), np.array([b]))[0]
    assert distance == pytest.approx(length(path))


def test_lattice_distances_are_the_ways_of_each_pair():
    blocked = problem(FENCE, (rectangle(30, 30, 70, 70),))
    places = np.array([[10.0, 50.0], [90.0, 50.0], [50.0, 10.0], [50.0, 90.0]])
    graph = visibility_graph(blocked)
    matrix = lattice_distances(blocked, places)
    assert matrix == pytest.approx(matrix.T)
    for start, row in zip(places, matrix, strict=True):
        assert row == pytest.approx(travel_distances(blocked, graph, start, places))


sizes = st.tuples(st.integers(0, 9), st.integers(0, 9), st.integers(1, 5), st.integers(1, 5))
blocks = st.lists(sizes.map(lambda s: 10.0 * rectangle(s[0], s[1], s[0] + s[2], s[1] + s[3])), min_size=1, max_size=6)


@given(blocks, st.data())
def test_ways_around_areas_that_touch_overlap_or_enclose_are_the_shortest_over_corners(no_fly, data):
    """Against all ways between all corners at once, by Floyd and Warshall."""
    blocked = problem(FENCE, tuple(no_fly))
    graph = visibility_graph(blocked)
    assume(len(graph.nodes) > 0)
    assert graph.flights is not None
    k = data.draw(st.integers(0, len(graph.nodes) - 1))
    apart = np.hypot(*(graph.nodes - graph.nodes[k]).T) > 1e-6
    distances = travel_distances(blocked, graph, graph.nodes[k], graph.nodes)
    assert distances[apart] == pytest.approx(floyd_warshall(graph.flights)[k, apart], abs=1e-9)


def test_a_way_from_a_corner_that_is_flown_around_starts_there():
    blocked = problem(FENCE, (rectangle(40, 20, 60, 95),))
    corner = visibility_graph(blocked).nodes[0]
    there = np.array([100.0, 100.0]) - corner
    path = travel_path(blocked, corner, there)
    assert length(path) == pytest.approx(travel_distances(blocked, visibility_graph(blocked), corner, there[None])[0])
    assert path[0].tolist() == corner.tolist()


def test_where_straight_flights_do_nothing_compiled_is_asked(monkeypatch):
    """While beliefs are compiled in the background, a first question to a kernel would hold up who asks."""
    monkeypatch.setattr(travel, "meetings", None)
    assert way(problem(FENCE), (10, 10), (90, 80)).tolist() == [[10, 10], [90, 80]]
    assert way(problem(), (10, 10), (290, 80)).tolist() == [[10, 10], [290, 80]]
    outside = travel.way_back(problem(FENCE), np.array([-20.0, 50.0]), np.array([100.5, 50.0]), 6.0)
    assert outside[1:].tolist() == [[1.0, 50.0], [99.0, 50.0], [100.5, 50.0]]


def test_only_convex_and_empty_air_is_straight():
    assert straight_suffices(problem())
    assert straight_suffices(problem(FENCE))
    assert not straight_suffices(problem(CORNER))
    assert not straight_suffices(problem(no_fly=(rectangle(1, 1, 2, 2),)))


def test_a_coast_of_a_thousand_corners_is_flown_around():
    angle = np.linspace(0, 2 * np.pi, 1000, endpoint=False)
    radius = 20 + 2 * np.cos(40 * angle)
    coast = np.column_stack([50 + radius * np.cos(angle), 50 + radius * np.sin(angle)])
    path = way(problem(FENCE, (coast,)), (10, 50), (90, 50))
    assert shapely.LineString(path).distance(shapely.Polygon(coast)) > 0.0
    around = shapely.MultiPoint([(10, 50), (90, 50), *coast]).convex_hull
    assert length(path) <= 0.5 * around.length + 3
