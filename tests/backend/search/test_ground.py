"""The ground at worst under a way, the altitude it is flown at, and what is closed to the planner."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from narrowing import known
from relief import hill, level, terrain
from shapely import Point, box

from backend.search.altitude import altitude_at, level_altitude
from backend.search.closed_by_ground import closed_by_ground
from backend.search.ground import LATERAL_TOLERANCE_M, VERTICAL_TOLERANCE_M, Ground
from backend.spec import FlightSpec
from hardware.frame import LocalFrame
from hardware.readings import Place

FRAME = LocalFrame(Place(50.0, 7.0))
FLAT = Ground(FRAME, 100.0)
FLIGHT = FlightSpec()


def over(shape, home_amsl_m: float = 100.0, spacing_m: float = 20.0) -> Ground:
    return Ground(FRAME, home_amsl_m, terrain(shape, spacing_m))


def test_without_terrain_the_ground_is_level_with_home_and_the_altitude_the_missions() -> None:
    assert FLAT.height_at(FRAME.to_geo(500.0, 0.0)) == 100.0
    assert level_altitude([(0.0, 0.0), (500.0, 0.0)], FLAT, FlightSpec(altitude_relative_m=12.0)) == 112.0


def test_a_hill_beside_the_way_counts_within_tolerance_only() -> None:
    beside = over(lambda east, north: np.where(north > 15.0, 150.0, 100.0), spacing_m=2.0)
    way = [(0.0, 0.0), (400.0, 0.0)]
    assert known(beside.below(way)).highest_m == pytest.approx(100.0)
    assert known(beside.below([(x, 8.0) for x, _ in way])).highest_m == pytest.approx(150.0)


def test_a_single_summit_between_the_samples_counts() -> None:
    ground = over(level(), spacing_m=20.0)
    heights = known(ground.terrain).heights
    middle = heights.shape[0] // 2
    heights[middle, middle + 10] = 130.0
    assert known(ground.below([(0.0, 3.0), (400.0, -4.0)])).highest_m == 130.0


def test_where_the_terrain_ends_nothing_is_known() -> None:
    assert over(level()).below([(0.0, 0.0), (2_900.0, 0.0)]) is not None
    assert over(level()).below([(0.0, 0.0), (3_100.0, 0.0)]) is None


@pytest.mark.parametrize(
    ("home_amsl_m", "expected"), [(100.0, (100.0, 100.0)), (108.0, (100.0, 108.0)), (92.0, (92.0, 100.0))]
)
def test_of_two_opinions_about_home_the_worse_counts(home_amsl_m: float, expected: tuple[float, float]) -> None:
    below = known(over(level(), home_amsl_m).below([(0.0, 0.0)]))
    assert (below.lowest_m, below.highest_m) == pytest.approx(expected)


def test_a_way_over_a_hill_is_flown_higher_and_over_the_plain_as_the_mission_says() -> None:
    ground = over(hill(300.0, 0.0, 60.0))
    assert level_altitude([(0.0, 0.0), (0.0, 300.0)], ground, FLIGHT) == 140.0
    high = level_altitude([(0.0, 0.0), (600.0, 0.0)], ground, FLIGHT)
    assert high == pytest.approx(160.0 + FLIGHT.minimum_clearance_m + VERTICAL_TOLERANCE_M, abs=1.0)
    assert altitude_at(FRAME.to_geo(300.0, 0.0), ground, FLIGHT) == pytest.approx(high, abs=1.0)


@pytest.mark.parametrize("drifted_m", [(2.0, 0.0), (-2.0, 0.0), (0.0, 2.0), (0.0, -2.0)])
def test_a_vehicle_that_drifts_while_it_hovers_over_a_slope_may_still_fly_its_way(
    drifted_m: tuple[float, float],
) -> None:
    """40 % steep. The altitude is chosen for a way from where it was; the vetoes ask from where it is."""
    ground = over(lambda east, north: 100.0 + 0.4 * east, home_amsl_m=140.0)
    flight = FlightSpec(maximum_altitude_relative_m=200.0)
    start, end = (100.0, 0.0), (60.0, 40.0)
    for here in (start, (start[0] + drifted_m[0], start[1] + drifted_m[1])):
        below = known(ground.below([here, end]))
        clearance = level_altitude([start, end], ground, flight) - VERTICAL_TOLERANCE_M - below.highest_m
        assert clearance >= flight.minimum_clearance_m


def test_where_the_band_leaves_too_little_for_drift_an_altitude_still_keeps_what_the_vetoes_ask() -> None:
    ground = over(lambda east, north: 100.0 + 0.4 * east)
    least = known(ground.below([(0.0, 0.0)])).highest_m + 20.0 + VERTICAL_TOLERANCE_M
    for room in (0.0, 0.5, 2.0):
        ceiling_m = least - ground.home_amsl_m + room
        tight = FlightSpec(altitude_relative_m=12.0, minimum_clearance_m=20.0, maximum_altitude_relative_m=ceiling_m)
        assert least <= level_altitude([(0.0, 0.0)], ground, tight) <= least + room + 1e-9


def test_over_a_hollow_it_is_flown_lower_when_the_ceiling_says_so() -> None:
    ground, flight = over(hill(300.0, 0.0, -60.0)), FlightSpec(maximum_above_ground_m=80.0)
    low = altitude_at(FRAME.to_geo(300.0, 0.0), ground, flight)
    assert low == pytest.approx(40.0 + 80.0 - VERTICAL_TOLERANCE_M, abs=1.0)


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 1000),
    ends=st.tuples(*[st.floats(-900.0, 900.0)] * 4),
    beside=st.floats(-LATERAL_TOLERANCE_M, LATERAL_TOLERANCE_M),
    along=st.floats(0.0, 1.0),
)
def test_nothing_within_tolerance_is_higher_or_lower_than_what_is_said(
    seed: int, ends: tuple[float, ...], beside: float, along: float
) -> None:
    rough = np.random.default_rng(seed).uniform(100.0, 160.0, (101, 101))
    ground = over(lambda east, north: rough[: east.shape[0], : east.shape[1]], spacing_m=60.0)
    ground = replace(ground, home_amsl_m=ground.home_by_terrain_m)
    (x0, y0), (x1, y1) = ends[:2], ends[2:]
    length = max(float(np.hypot(x1 - x0, y1 - y0)), 1e-9)
    x = x0 + along * (x1 - x0) - beside * (y1 - y0) / length
    y = y0 + along * (y1 - y0) + beside * (x1 - x0) / length
    below, here = known(ground.below([(x0, y0), (x1, y1)])), ground.height_at(FRAME.to_geo(x, y))
    assert below.lowest_m - 0.5 <= known(here) <= below.highest_m + 0.5


def test_a_mountain_and_what_lies_behind_it_are_closed_to_the_planner() -> None:
    fence = box(-100.0, -400.0, 1500.0, 400.0)
    closed = closed_by_ground(over(hill(600.0, 0.0, 160.0, 150.0)), FLIGHT, fence)
    assert closed is not None
    assert closed.contains(Point(600.0, 0.0))
    assert closed.contains(Point(1_200.0, 0.0))
    assert not closed.intersects(Point(200.0, 0.0))
    assert not closed.intersects(Point(600.0, 390.0))


def test_a_hill_that_the_band_clears_closes_nothing() -> None:
    fence = box(-100.0, -400.0, 1500.0, 400.0)
    assert closed_by_ground(over(hill(600.0, 0.0, 60.0, 150.0)), FLIGHT, fence) is None
    assert closed_by_ground(FLAT, FLIGHT, fence) is None


def test_unknown_ground_is_closed() -> None:
    ground = Ground(FRAME, 100.0, terrain(level(), reach_m=500.0))
    closed = closed_by_ground(ground, FLIGHT, box(-100.0, -100.0, 1000.0, 100.0))
    assert closed is not None
    assert closed.contains(Point(800.0, 0.0))


def test_the_share_that_is_known_and_the_highest_ground() -> None:
    ground = Ground(FRAME, 100.0, terrain(hill(200.0, 0.0, 50.0), reach_m=500.0))
    assert ground.known_share(box(-300.0, -300.0, 300.0, 300.0)) == 1.0
    assert ground.known_share(box(0.0, 0.0, 1000.0, 100.0)) == pytest.approx(0.5, abs=0.03)
    assert ground.highest_in(box(0.0, -100.0, 400.0, 100.0)) == pytest.approx(150.0, abs=0.5)


def test_the_profile_is_the_ground_straight_below() -> None:
    along, heights = over(hill(300.0, 0.0, 60.0)).profile([(0.0, 0.0), (600.0, 0.0)])
    assert along[-1] == pytest.approx(600.0)
    assert heights.max() == pytest.approx(160.0, abs=0.5)
    assert abs(along[heights.argmax()] - 300.0) < 5.0
