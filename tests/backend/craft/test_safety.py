from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

import numpy as np
import pytest
from facts import FAILSAFE, GIVEN_BACK, PILOT
from hypothesis import given
from hypothesis import strategies as st
from relief import Shape, hill, level, terrain
from shapely import box

from backend.craft.safety import (
    LANDING_S,
    Limits,
    Situation,
    battery_to_return_percent,
    place_vetoes,
    resume_vetoes,
    standing_vetoes,
    start_vetoes,
    staying_vetoes,
    turn_vetoes,
    vehicle_vetoes,
)
from backend.reasons import Reason, safety
from backend.search.area import EDGE_TOLERANCE_M
from backend.search.ground import Ground
from backend.spec import FlightSpec
from hardware.frame import LocalFrame
from hardware.readings import Place, Telemetry
from planner.reason import remedy_of

HOME = Place(50.0, 7.0)
FRAME = LocalFrame(HOME)
LIMITS = Limits(
    frame=FRAME,
    fence=box(-50, -50, 400, 200),
    no_fly=(box(100, 0, 150, 100),),
    ground=Ground(FRAME, 100.0),
    flight=FlightSpec(),
    reserve_percent=25.0,
    battery_telemetry=True,
    speed_m_s=7.0,
    measurement_time_s=30.0,
)


def telemetry(east: float = 0.0, north: float = 0.0, **more: object) -> Telemetry:
    return replace(
        Telemetry(connected=True, at_s=1000.0, position=FRAME.to_geo(east, north), position_at_s=1000.0),
        **{"battery_percent": 90.0, "in_air": True, **more},  # type: ignore[arg-type]
    )


def situation(**more: object) -> Situation:
    return Situation(telemetry(**more), now_s=1000.5)  # type: ignore[arg-type]


def kinds(vetoes: Iterable[Reason]) -> list[type]:
    return [type(veto) for veto in vetoes]


def rules(east: float, north: float, seen: Situation, amsl: float = 140.0) -> list[type]:
    return kinds(place_vetoes(LIMITS, seen, FRAME.to_geo(east, north), amsl))


def test_a_good_place_is_allowed() -> None:
    assert rules(50, 100, situation()) == []


@pytest.mark.parametrize(
    ("east", "north", "rule"),
    [
        (500, 0, safety.OutsideFence),
        (-80, 0, safety.OutsideFence),
        (120, 50, safety.InsideNoFly),
        (200, 50, safety.WayCrossesNoFly),
        (9_000, 0, safety.TooFarFromHome),
    ],
)
def test_places_outside_inside_a_zone_or_behind_one_are_refused(east: float, north: float, rule: type) -> None:
    assert rules(east, north, situation(north=50.0)) == [rule]


@pytest.mark.parametrize(("east", "refused"), [(99.0, True), (97.5, False), (151.0, True), (153.0, False)])
def test_a_place_beside_a_zone_is_refused_where_a_hovering_vehicle_would_wander_into_it(
    east: float, refused: bool
) -> None:
    here = situation(east=east - math.copysign(1.0, 125.0 - east), north=50.0)
    found = place_vetoes(LIMITS, here, FRAME.to_geo(east, 50.0), 140.0)
    assert kinds(found) == [safety.NearNoFly] * refused
    for veto in found:
        assert isinstance(veto, safety.NearNoFly)
        assert veto.near_m == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("east", [99.999_999, 100.0, 100.000_001])
def test_a_place_on_the_border_of_a_zone_is_refused_once(east: float) -> None:
    (rule,) = rules(east, 50.0, situation(east=90.0, north=50.0))
    assert rule in (safety.InsideNoFly, safety.NearNoFly)


@pytest.mark.parametrize(
    ("inside", "rule"), [(0.5 * EDGE_TOLERANCE_M, []), (2.0 * EDGE_TOLERANCE_M, [safety.WayCrossesNoFly])]
)
def test_a_vehicle_that_wandered_into_a_zone_may_fly_out_of_it(inside: float, rule: list[type]) -> None:
    assert rules(50, 50, situation(east=100.0 + inside, north=50.0)) == rule


def test_the_way_may_not_leave_a_fence_that_is_not_convex() -> None:
    bent = replace(LIMITS, fence=box(0, 0, 20, 200).union(box(0, 0, 200, 20)), no_fly=())
    seen = situation(east=10.0, north=190.0)
    assert kinds(place_vetoes(bent, seen, FRAME.to_geo(190, 10), 140.0)) == [safety.WayLeavesFence]
    assert place_vetoes(bent, seen, FRAME.to_geo(10, 10), 140.0) == ()


@pytest.mark.parametrize(("amsl", "allowed"), [(105.0, False), (111.0, True), (219.0, True), (225.0, False)])
def test_the_altitude_band_is_above_home(amsl: float, allowed: bool) -> None:
    assert (rules(50, 100, situation(), amsl) == []) is allowed


def test_the_pilot_the_failsafe_a_lost_link_and_an_old_position_veto_everything() -> None:
    for seen, rule in (
        (situation(authority=PILOT), safety.PilotControls),
        (situation(authority=FAILSAFE), safety.FailsafeActs),
        (situation(connected=False), safety.NoLink),
        (Situation(telemetry(), now_s=1010.0), safety.PositionOld),
        (situation(position_at_s=None), safety.NoPosition),
    ):
        assert kinds(vehicle_vetoes(seen)) == [rule]
        for vetoes in (
            start_vetoes(LIMITS, replace(seen)),
            turn_vetoes(LIMITS, seen),
            place_vetoes(LIMITS, seen, HOME, 140.0),
        ):
            assert rule in kinds(vetoes)


def test_a_battery_that_is_not_known_vetoes_unless_the_mission_says_that_it_never_is() -> None:
    unknown = situation(battery_percent=None)
    assert turn_vetoes(LIMITS, unknown) == (safety.BatteryUnknown(),)
    assert kinds(start_vetoes(LIMITS, situation(battery_percent=None, in_air=False))) == [safety.BatteryUnknown]
    assert rules(50, 100, unknown) == [safety.BatteryUnknown]
    assert turn_vetoes(replace(LIMITS, battery_telemetry=False), unknown) == ()


def test_a_battery_that_fell_silent_vetoes() -> None:
    assert turn_vetoes(LIMITS, situation(battery_at_s=990.0)) == ()
    assert turn_vetoes(LIMITS, situation(battery_at_s=960.0)) == (safety.BatterySilent(),)


@given(charge=st.floats(0, 100), east=st.floats(-40, 390), north=st.floats(110, 190), drain=st.floats(0.01, 1.0))
def test_whatever_is_allowed_leaves_the_way_home_and_the_reserve(
    charge: float, east: float, north: float, drain: float
) -> None:
    seen = Situation(telemetry(0.0, 150.0, battery_percent=charge), 1000.0, drain)
    place = FRAME.to_geo(east, north)
    vetoed = safety.BatteryShort in kinds(place_vetoes(LIMITS, seen, place, 140.0))
    there_s = math.dist((0.0, 150.0), (east, north)) / 7.0 + 30.0
    home_s = math.hypot(east, north) / 7.0 + LANDING_S
    left = charge - drain * (there_s + home_s)
    if abs(left - 25.0) > 1e-3:
        assert vetoed == (left < 25.0)


def test_the_way_home_costs_more_from_farther_away() -> None:
    near, far = (battery_to_return_percent(LIMITS, FRAME.to_geo(e, 0), 0.1) for e in (10.0, 300.0))
    assert far - near == pytest.approx(0.1 * 290.0 / 7.0, rel=1e-3)


def test_a_start_needs_the_ground_and_a_place_inside_the_fence() -> None:
    assert start_vetoes(LIMITS, situation(in_air=False)) == ()
    assert start_vetoes(LIMITS, situation(in_air=True)) == (safety.AlreadyInAir(),)
    (outside,) = start_vetoes(LIMITS, situation(in_air=False, east=-50.0 - 30.0))
    assert isinstance(outside, safety.OutsideFence)
    assert (outside.what, outside.beyond_m) == ("vehicle_stands", pytest.approx(30.0, abs=0.1))
    drifted = situation(in_air=False, east=-50.0 - 0.5 * EDGE_TOLERANCE_M)
    assert start_vetoes(LIMITS, drifted) == ()


def test_a_vehicle_that_a_pilot_landed_and_disarmed_may_start_again_an_armed_one_may_not() -> None:
    assert start_vetoes(LIMITS, situation(in_air=False, armed=False, authority=PILOT)) == ()
    assert start_vetoes(LIMITS, situation(in_air=False, armed=True, authority=PILOT)) == (safety.PilotControls(),)


def test_resuming_is_vetoed_until_the_pilot_has_given_back_unless_it_is_the_failsafe() -> None:
    assert resume_vetoes(telemetry(authority=GIVEN_BACK, mode="HOLD")) == ()
    assert resume_vetoes(telemetry()) == ()
    assert resume_vetoes(telemetry(authority=FAILSAFE, mode="RETURN")) == ()
    assert resume_vetoes(telemetry(authority=PILOT, mode="RETURN")) == (safety.NotGivenBack("RETURN"),)


def test_a_vehicle_in_the_air_stays_only_within_limits_that_hold_its_home_too() -> None:
    assert staying_vetoes(LIMITS, situation(east=60.0, north=50.0)) == ()
    away = replace(LIMITS, fence=box(200, 0, 400, 200))
    home, vehicle = staying_vetoes(away, situation(east=60.0, north=50.0))
    assert isinstance(home, safety.OutsideFence)
    assert isinstance(vehicle, safety.OutsideFence)
    assert (home.what, vehicle.what) == ("home", "vehicle")
    zone = replace(LIMITS, no_fly=(box(-9, -9, 9, 9),))
    assert staying_vetoes(zone, situation(east=60.0, north=50.0)) == (safety.InsideNoFly("home"),)


def test_a_place_may_be_judged_without_a_vehicle() -> None:
    assert standing_vetoes(LIMITS, FRAME.to_geo(50, 100), 140.0) == ()
    assert kinds(standing_vetoes(LIMITS, FRAME.to_geo(500, 0), 140.0)) == [safety.OutsideFence]


def test_every_veto_says_how_to_mend_it() -> None:
    bad = Situation(telemetry(north=50.0, authority=PILOT, battery_percent=5.0), now_s=2000.0)
    vetoes = place_vetoes(LIMITS, bad, FRAME.to_geo(500, 0), 500.0)
    assert len(vetoes) >= 4
    for veto in vetoes:
        assert remedy_of(veto)


def over(shape: Shape, **flight: object) -> Limits:
    return replace(
        LIMITS,
        fence=box(-500, -500, 1500, 500),
        no_fly=(),
        ground=Ground(FRAME, 100.0, terrain(shape)),
        flight=FlightSpec(**flight),  # type: ignore[arg-type]
    )


def flown(limits: Limits, east: float, north: float, amsl: float, seen: Situation | None = None) -> list[type]:
    return kinds(place_vetoes(limits, seen or situation(), FRAME.to_geo(east, north), amsl))


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
    (veto,) = place_vetoes(limits, situation(east=800.0), FRAME.to_geo(810, 0), 140.0)
    assert isinstance(veto, safety.ClearanceShort)
    assert veto.where == "way_home"


def test_a_start_beside_ground_that_rises_at_once_is_refused() -> None:
    steep = over(lambda east, north: np.where(east > 5.0, 320.0, 100.0))
    (veto,) = start_vetoes(steep, situation(in_air=False))
    assert isinstance(veto, safety.TooHighAboveGround)
    assert veto.where == "take_off"


def test_without_terrain_the_band_alone_holds() -> None:
    low = replace(LIMITS, flight=FlightSpec(altitude_relative_m=12.0))
    assert kinds(place_vetoes(low, situation(), FRAME.to_geo(50, 100), 112.0)) == []
