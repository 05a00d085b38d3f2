from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.autopilot.fence_items import FenceItem, FenceUnreadable, first_difference, items_of, zones_of
from hardware.fence import FenceCircle, FencePolygon, FenceReturnPoint, FenceZone
from hardware.readings import Place

places = st.builds(
    Place, st.floats(-90, 90).map(lambda v: round(v, 7)), st.floats(-180, 180).map(lambda v: round(v, 7))
)
zones = st.lists(
    st.builds(FencePolygon, st.lists(places, min_size=3, max_size=8).map(tuple), st.booleans())
    | st.builds(FenceCircle, places, st.floats(1.0, 5_000.0), st.booleans())
    | st.builds(FenceReturnPoint, places),
    max_size=5,
).map(tuple)


@given(zones)
def test_what_is_sent_can_be_read_again(sent: tuple[FenceZone, ...]) -> None:
    assert first_difference(sent, zones_of(items_of(sent))) is None


TRIANGLE = FencePolygon((Place(47.0, 8.0), Place(47.0, 8.001), Place(47.001, 8.0)), True)


def test_a_corner_that_is_elsewhere_missing_or_of_another_kind_is_found() -> None:
    moved = FencePolygon((*TRIANGLE.corners[:2], Place(47.0011, 8.0)), True)
    assert first_difference((TRIANGLE,), (moved,)) == 2
    assert first_difference((TRIANGLE,), ()) == 0
    assert first_difference((), (TRIANGLE,)) == 0
    assert first_difference((TRIANGLE,), (FencePolygon(TRIANGLE.corners, False),)) == 0
    within = FencePolygon(tuple(Place(c.lat + 1e-7, c.lon) for c in TRIANGLE.corners), True)
    assert first_difference((TRIANGLE,), (within,)) is None  # a centimetre


@pytest.mark.parametrize(
    "items",
    [
        [FenceItem(5001, 3.0, 0, 0)] * 2,
        [FenceItem(5001, 2.0, 0, 0)] * 2,
        [FenceItem(5001, math.nan, 0, 0)] * 3,
        [FenceItem(5001, 3.0, 0, 0)] * 2 + [FenceItem(5002, 3.0, 0, 0)],
        [FenceItem(5001, 3.0, 2_000_000_000, 0)] * 3,
        [FenceItem(5003, math.nan, 0, 0)],
        [FenceItem(5004, -1.0, 0, 0)],
        [FenceItem(16, 0.0, 0, 0)],
    ],
)
def test_what_is_no_fence_is_refused(items: list[FenceItem]) -> None:
    with pytest.raises(FenceUnreadable):
        zones_of(items)
