"""The mission rules over ground that rises and falls: clearance, ceiling, and the way home over it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from air import still_air
from airspace import airspace
from craft_limits import FRAME, LIMITS, kinds, situation
from numpy.typing import NDArray
from relief import Shape, hill, level, terrain
from shapely import Polygon, box

from backend.craft.safety import (
    Limits,
    Situation,
    battery_to_return_percent,
    ground_return_vetoes,
    ground_vetoes,
    place_vetoes,
    standing_vetoes,
    start_vetoes,
)
from backend.reasons import safety
from backend.search.altitude import level_altitude
from backend.search.ground import Ground
from backend.spec import FlightSpec


def over(shape: Shape, **flight: object) -> Limits:
    wide = box(-500, -500, 1500, 500)
    return replace(
        LIMITS,
        fence=wide,
        no_fly=(),
        problem=airspace(wide),
        ground=Ground(FRAME, 100.0, terrain(shape)),
        flight=FlightSpec(**flight),  # type: ignore[arg-type]
    )


def flown(limits: Limits, east: float, north: float, amsl: float, seen: Situation | None = None) -> list[type]:
    lasting = replace(seen or situation(), endurance=still_air(0.02))
    return kinds(place_vetoes(limits, lasting, FRAME.to_geo(east, north), amsl))


def test_a_way_over_a_hill_is_refused_below_the_clearance_and_allowed_above() -> None:
    limits = over(hill(300.0, 0.0, 60.0))
    assert flown(limits, 600, 0, 140.0) == [safety.ClearanceShort]
    assert flown(limits, 600, 0, 184.0) == []
    assert flown(limits, 0, 300, 140.0) == []


def test_a_way_over_a_hollow_is_refused_above_the_ceiling() -> None:
    limits = over(hill(300.0, 0.0, -60.0), maximum_above_ground_m=80.0)
    assert flown(limits, 600, 0, 140.0) == [safety.TooHighAboveGround]


def test_a_way_over_unknown_ground_is_refused() -> None:
    limits = replace(over(level()), ground=Ground(FRAME, 100.0, terrain(level(), reach_m=300.0)))
    assert flown(limits, 400, 0, 140.0) == [safety.GroundUnknown]


def test_a_place_from_which_no_way_leads_home_is_refused() -> None:
    """The vehicle is behind the mountain already; a place beside it would be fine, but for the way home."""
    limits = over(hill(400.0, 0.0, 160.0), maximum_above_ground_m=300.0)
    behind = replace(situation(east=800.0), endurance=still_air(0.02))
    (veto,) = place_vetoes(limits, behind, FRAME.to_geo(810, 0), 140.0)
    assert isinstance(veto, safety.ClearanceShort)
    assert veto.where == "way_home"


def test_a_place_whose_way_home_leads_around_a_zone_over_a_mountain_is_refused() -> None:
    """Straight over the zone nothing would be against it."""
    limits = over(hill(300.0, 250.0, 160.0), maximum_above_ground_m=300.0)
    behind = replace(situation(east=590.0), endurance=still_air(0.02))
    place = FRAME.to_geo(600.0, 0.0)
    assert place_vetoes(limits, behind, place, 140.0) == ()
    wall, fence = box(250.0, -490.0, 350.0, 200.0), limits.fence
    assert isinstance(fence, Polygon)
    walled = replace(limits, no_fly=(wall,), problem=airspace(fence, wall))
    (veto,) = place_vetoes(walled, behind, place, 140.0)
    assert isinstance(veto, safety.ClearanceShort)
    assert veto.where == "way_home"


def test_a_start_beside_ground_that_rises_at_once_is_refused() -> None:
    steep = over(lambda east, north: np.where(east > 5.0, 320.0, 100.0))
    (veto,) = start_vetoes(steep, situation(in_air=False))
    assert isinstance(veto, safety.TooHighAboveGround)
    assert veto.where == "take_off"


def test_the_climb_that_the_ground_of_the_way_home_asks_for_takes_battery() -> None:
    place, endurance = FRAME.to_geo(600.0, 0.0), still_air(0.02)
    flat = battery_to_return_percent(over(level()), place, endurance, 40.0)
    assert flat == battery_to_return_percent(
        replace(over(level()), ground=Ground(FRAME, 100.0)), place, endurance, 40.0
    )
    assert battery_to_return_percent(over(hill(300.0, 0.0, 60.0)), place, endurance, 40.0) > flat + 1.0


def test_a_way_home_has_to_keep_the_clearance_but_not_the_ceiling() -> None:
    way = [(600.0, 0.0), (0.0, 0.0)]
    assert kinds(ground_return_vetoes(over(hill(300.0, 0.0, 60.0)), way, 140.0)) == [safety.ClearanceShort]
    assert ground_return_vetoes(over(hill(300.0, 0.0, -60.0), maximum_above_ground_m=80.0), way, 140.0) == ()
    unknown = replace(over(level()), ground=Ground(FRAME, 100.0, terrain(level(), reach_m=300.0)))
    assert kinds(ground_return_vetoes(unknown, way, 140.0)) == [safety.GroundUnknown]


def test_a_way_home_above_the_ceiling_is_the_lowest_there_is_and_no_place_is_chosen_that_needs_it() -> None:
    def ridge_behind_a_valley(east: NDArray[np.float64], north: NDArray[np.float64]) -> NDArray[np.float64]:
        return hill(700.0, 0.0, 80.0)(east, north) + hill(300.0, 0.0, -60.0, base_m=0.0)(east, north)

    limits, way = over(ridge_behind_a_valley, maximum_above_ground_m=80.0), [(700.0, 0.0), (0.0, 0.0)]
    altitude = level_altitude(way, limits.ground, limits.flight)
    assert kinds(ground_vetoes(limits, way, altitude, "way_home")) == [safety.TooHighAboveGround]
    assert ground_return_vetoes(limits, way, altitude) == ()
    assert kinds(ground_return_vetoes(limits, way, altitude - 0.5)) == [safety.ClearanceShort]
    (veto,) = standing_vetoes(limits, FRAME.to_geo(700.0, 0.0), altitude)
    assert isinstance(veto, safety.TooHighAboveGround)
    assert veto.where == "way_home"
