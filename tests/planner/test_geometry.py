"""Polygon operations against shapely, and the refusals of unusable polygons."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from refusals import refusing

from planner import geometry
from planner.geometry import (
    bounds,
    cells_touching,
    clip_convex,
    clip_wedge,
    contains,
    contains_each,
    convex_hull,
    distance_to_convex,
    region_area,
    signed_area,
    validate_area,
    wedge_polygon,
)
from planner.reasons import AreaCrossesItself, UnusableArea

SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
HOLE = np.array([[4.0, 4.0], [6.0, 4.0], [6.0, 6.0], [4.0, 6.0]])

coordinate = st.floats(-100, 100, allow_nan=False).map(lambda v: round(v, 3))
points = st.lists(st.tuples(coordinate, coordinate), min_size=3, max_size=12, unique=True).map(np.array)


def star(seed: int, corners: int) -> np.ndarray:
    """A simple, usually non-convex polygon: corners in angular order around the origin."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, 2 * np.pi, corners))
    radii = rng.uniform(10, 100, corners)
    return np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])


stars = st.builds(star, st.integers(0, 10_000), st.integers(5, 12)).filter(
    lambda ring: shapely.Polygon(ring).is_valid and abs(signed_area(ring)) > 1.0
)


@given(points)
def test_hull_is_shapelys(cloud):
    hull = shapely.MultiPoint(cloud).convex_hull
    ours = convex_hull(cloud)
    if isinstance(hull, shapely.Polygon) and hull.area > 1e-6:
        assert signed_area(ours) == pytest.approx(hull.area)
        assert shapely.Polygon(ours).symmetric_difference(hull).area == pytest.approx(0.0, abs=1e-6)


@given(stars, coordinate, coordinate, st.floats(-np.pi, np.pi), st.floats(0.02, 1.3))
def test_wedge_clip_has_shapelys_area(ring, x, y, angle, half_angle):
    clipped = clip_wedge(ring, x, y, angle, half_angle)
    wedge = shapely.Polygon(wedge_polygon(x, y, angle, half_angle, 1000.0))
    expected = shapely.Polygon(ring).intersection(wedge).area
    assert abs(signed_area(clipped)) == pytest.approx(expected, rel=1e-6, abs=1e-6)


@given(points, points)
def test_convex_clip_has_shapelys_area(cloud, other):
    a, b = convex_hull(cloud), convex_hull(other)
    if len(a) >= 3 and len(b) >= 3 and min(abs(signed_area(a)), abs(signed_area(b))) > 1e-3:
        expected = shapely.Polygon(a).intersection(shapely.Polygon(b)).area
        assert abs(signed_area(clip_convex(a, b[::-1]))) == pytest.approx(expected, rel=1e-6, abs=1e-5)


def test_wedge_of_nearly_zero_width_leaves_the_line_of_sight():
    sliver = clip_wedge(SQUARE, -5.0, 5.0, 0.0, 1e-9)
    assert len(sliver) >= 3
    assert np.allclose(sliver[:, 1], 5.0, atol=1e-7)


def test_wedge_that_looks_away_leaves_nothing():
    assert len(clip_wedge(SQUARE, -5.0, 5.0, np.pi, 0.1)) == 0


@given(st.lists(stars | points, max_size=6), st.lists(st.tuples(coordinate, coordinate), max_size=9).map(np.array))
def test_every_ring_alone_contains_what_it_does_among_others(rings, places):
    assert contains_each(rings, places).shape == (len(rings), len(places))
    for ring, inside in zip(rings, contains_each(rings, places), strict=True):
        assert (contains((ring,), places) == inside).all()


def test_more_places_than_are_asked_at_once_are_all_answered(monkeypatch):
    places = np.random.default_rng(1).uniform(-5, 15, (50, 2))
    whole = contains_each((SQUARE, HOLE), places)
    monkeypatch.setattr(geometry, "AT_ONCE", 3 * 8)
    assert (contains_each((SQUARE, HOLE), places) == whole).all()


@given(stars, st.lists(st.tuples(coordinate, coordinate), min_size=1, max_size=20).map(np.array))
def test_contains_agrees_with_shapely_off_the_border(ring, places):
    polygon = shapely.Polygon(ring)
    off_border = [polygon.exterior.distance(shapely.Point(p)) > 1e-6 for p in places]
    inside = [polygon.contains(shapely.Point(p)) for p in places]
    assert (contains((ring,), places) == inside)[off_border].all()


def test_a_ring_inside_another_is_a_hole():
    assert contains((SQUARE, HOLE), np.array([[5.0, 5.0], [2.0, 2.0]])).tolist() == [False, True]
    assert region_area((SQUARE, HOLE)) == pytest.approx(96.0)


@given(points, st.lists(st.tuples(coordinate, coordinate), min_size=1, max_size=10).map(np.array))
def test_distance_to_hull_is_shapelys(cloud, places):
    hull = convex_hull(cloud)
    shape = shapely.MultiPoint(cloud).convex_hull
    expected = [shape.distance(shapely.Point(p)) for p in places]
    assert distance_to_convex(places, hull) == pytest.approx(expected, abs=1e-6)


@given(stars)
def test_cells_touching_are_those_that_intersect(ring):
    x0, y0, x1, y1 = bounds((ring,))
    h = max(x1 - x0, y1 - y0) / 15
    nx, ny = int(np.ceil((x1 - x0) / h - 1e-9)), int(np.ceil((y1 - y0) / h - 1e-9))
    touched = cells_touching((ring,), x0, y0, h, nx, ny)
    polygon = shapely.Polygon(ring)
    for row in range(ny):
        for column in range(nx):
            cell = shapely.box(x0 + column * h, y0 + row * h, x0 + (column + 1) * h, y0 + (row + 1) * h)
            shared = polygon.intersection(cell).area
            if shared > 1e-6 * h * h:
                assert touched[row, column]
            elif polygon.distance(cell) > 1e-6 * h:
                assert not touched[row, column]


@pytest.mark.parametrize(
    ("ring", "reason"),
    [
        (np.array([[0.0, 0.0], [1.0, 0.0]]), UnusableArea("too_few_corners")),
        (np.array([[0.0, 0.0], [1.0, np.nan], [1.0, 1.0]]), UnusableArea("not_finite")),
        (np.array([[0.0, 0.0], [10.0, 10.0], [10.0, 0.0], [0.0, 10.0]]), AreaCrossesItself),
        (np.array([[0.0, 0.0], [5.0, 5.0], [10.0, 10.0]]), UnusableArea("no_extent")),
        (np.array([[1.0, 1.0], [1.0, 1.0], [1.0, 1.0]]), UnusableArea("no_extent")),
    ],
)
def test_unusable_polygons_are_refused_with_the_reason(ring, reason):
    with refusing(reason):
        validate_area((ring,))


def test_no_polygon_at_all_is_refused():
    with refusing(UnusableArea("no_ring")):
        validate_area(())


def test_a_closing_corner_is_dropped():
    closed = np.vstack([SQUARE, SQUARE[:1]])
    assert len(validate_area((closed,))[0]) == 4
