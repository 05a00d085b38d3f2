"""Which straight flights meet which borders, against shapely."""

import numpy as np
import shapely
from hypothesis import given
from hypothesis import strategies as st

from planner.kernels.crossing import CROSSES, FREE, TOUCHES, meetings

SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])

place = st.tuples(st.floats(-100, 100), st.floats(-100, 100))
places = st.lists(place, min_size=1, max_size=4).map(np.array)
exact_place = st.tuples(st.integers(-9, 9), st.integers(-9, 9))
many_rings = st.lists(
    st.lists(exact_place, min_size=3, max_size=9, unique=True).map(lambda p: np.array(p, float)),
    min_size=8,
    max_size=20,
)
rings = st.lists(place, min_size=3, max_size=12, unique=True).map(np.array)


def clearly_crosses(line, edge):
    ends = [shapely.Point(p) for p in line.coords], [shapely.Point(p) for p in edge.coords]
    clear = all(p.distance(edge) > 1e-6 for p in ends[0]) and all(p.distance(line) > 1e-6 for p in ends[1])
    return clear and line.crosses(edge)


@given(places, places, rings, rings)
def test_each_pair_is_judged_as_shapely_does(starts, ends, ring, other):
    met = meetings(starts, ends, (ring, other))
    borders = [shapely.LineString(e) for r in (ring, other) for e in zip(r, np.roll(r, -1, axis=0), strict=True)]
    assert met.shape == (len(starts), len(ends))
    for start, row in zip(starts, met, strict=True):
        for end, judged in zip(ends, row, strict=True):
            line = shapely.LineString([start, end])
            if min(line.distance(edge) for edge in borders) > 1e-6:
                assert judged == FREE
            if any(clearly_crosses(line, edge) for edge in borders):
                assert judged == CROSSES


@given(st.lists(exact_place, min_size=1, max_size=60).map(lambda p: np.array(p, float)), many_rings)
def test_many_edges_find_what_each_finds_alone(ends, rings):
    """Whole metres: the same numbers whichever end an edge begins at. With many ends the nearest are asked first."""
    sides = [np.stack(e) for ring in rings for e in zip(ring, np.roll(ring, -1, axis=0), strict=True)]
    alone = np.max([meetings(ends[:3], ends, (side,)) for side in sides], axis=0)
    assert (meetings(ends[:3], ends, tuple(rings)) == alone).all()


def test_flying_through_two_corners_touches_but_does_not_cross():
    assert meetings(np.array([[-1.0, -1.0]]), np.array([[11.0, 11.0]]), (SQUARE,)) == TOUCHES


def test_flying_along_a_side_touches_and_through_it_crosses():
    ends = np.array([[11.0, 0.0], [5.0, 5.0], [-1.0, 8.0]])
    assert meetings(np.array([[-1.0, 0.0]]), ends, (SQUARE,)).tolist() == [[TOUCHES, CROSSES, FREE]]


def test_without_borders_all_is_free():
    assert meetings(SQUARE, SQUARE, ()).tolist() == [[FREE] * 4] * 4
