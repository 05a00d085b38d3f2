from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from air import still_air
from airspace import airspace
from craft_limits import FENCE, FRAME, HOME, LIMITS, ZONE, kinds, situation, telemetry
from facts import FAILSAFE, GIVEN_BACK, PILOT
from hypothesis import given
from hypothesis import strategies as st
from shapely import Polygon, box

from backend.craft.checklist import lasts_for
from backend.craft.endurance import LEG_S, landing_s, unknown
from backend.craft.safety import (
    Situation,
    battery_to_return_percent,
    place_vetoes,
    resume_vetoes,
    return_vetoes,
    standing_vetoes,
    start_vetoes,
    staying_vetoes,
    turn_vetoes,
    vehicle_vetoes,
)
from backend.craft.watch.battery import battery_stage
from backend.reasons import safety
from backend.search.area import EDGE_TOLERANCE_M
from backend.spec import FlightSpec
from hardware.reasons.vehicle_news import ClockRateOdd, SwitchUndone
from planner.reason import remedy_of


def test_while_the_autopilots_clock_is_odd_no_turn_is_begun_and_the_way_home_stays_open() -> None:
    odd = situation(odd_clock_rate=0.9)
    assert turn_vetoes(LIMITS, odd) == (ClockRateOdd(0.9),)
    assert return_vetoes(LIMITS, odd, [(0.0, 0.0)], 140.0) == ()
    assert vehicle_vetoes(odd) == ()


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
    seen = Situation(telemetry(0.0, 150.0, battery_percent=charge), 1000.0, still_air(drain))
    place = FRAME.to_geo(east, north)
    vetoed = safety.BatteryShort in kinds(place_vetoes(LIMITS, seen, place, 140.0))
    there_s = math.dist((0.0, 150.0), (east, north)) / 7.0 + 30.0
    home_s = math.hypot(east, north) / 7.0 + landing_s(40.0)
    left = charge - drain * (there_s + home_s)
    assert vetoed or left >= 25.0
    assert not vetoed or left - drain * 250.0 < 25.0 + 2.0


def test_the_way_home_costs_more_from_farther_away_and_around_a_zone() -> None:
    def takes(east: float, north: float) -> float:
        return battery_to_return_percent(LIMITS, FRAME.to_geo(east, north), still_air(0.1), 40.0)

    assert takes(90.0, 0.0) - takes(20.0, 0.0) == pytest.approx(1.0, rel=0.05)
    straight = math.hypot(200.0, 50.0) / 7.0
    assert takes(200.0, 50.0) - takes(20.0, 0.0) > 0.1 * (straight - 20.0 / 7.0) + 0.1 * LEG_S


def test_a_vehicle_that_is_low_climbs_for_the_way_home_and_one_that_is_high_sinks_longer() -> None:
    def takes(altitude: float | None) -> float:
        return battery_to_return_percent(LIMITS, FRAME.to_geo(80.0, 0.0), still_air(0.1), altitude)

    assert takes(5.0) > takes(40.0) == takes(None)
    assert takes(120.0) > takes(40.0)


def test_a_start_needs_the_ground_and_a_place_inside_the_fence() -> None:
    assert start_vetoes(LIMITS, situation(in_air=False)) == ()
    assert start_vetoes(LIMITS, situation(in_air=True)) == (safety.AlreadyInAir(),)
    (outside,) = start_vetoes(LIMITS, situation(in_air=False, east=-50.0 - 30.0))
    assert isinstance(outside, safety.OutsideFence)
    assert (outside.what, outside.beyond_m) == ("vehicle_stands", pytest.approx(30.0, abs=0.1))
    drifted = situation(in_air=False, east=-50.0 - 0.5 * EDGE_TOLERANCE_M)
    assert start_vetoes(LIMITS, drifted) == ()


WALLS = (box(-30, 20, 30, 30), box(-30, -30, 30, -20), box(20, -30, 30, 30), box(-30, -30, -20, 30))


@pytest.mark.parametrize("zones", [(box(-30, -30, 30, 30).difference(box(-20, -20, 20, 20)),), WALLS])
def test_nothing_takes_off_where_no_fly_zones_let_it_go_nowhere(zones: tuple[Polygon, ...]) -> None:
    enclosed = replace(LIMITS, no_fly=zones, problem=airspace(FENCE, *zones))
    assert start_vetoes(enclosed, situation(in_air=False)) == (safety.InsideNoFly("vehicle_stands"),)
    gap = box(-100, -10, 0, 10)
    opened = tuple(zone.difference(gap) for zone in zones)
    left_open = replace(LIMITS, no_fly=opened, problem=airspace(FENCE, *opened))  # pyright: ignore[reportArgumentType]
    assert start_vetoes(left_open, situation(in_air=False)) == ()


@given(altitude=st.floats(2, 500), low=st.floats(0, 500), high=st.floats(2, 1000))
def test_nothing_takes_off_to_or_flies_at_an_altitude_outside_the_band(
    altitude: float, low: float, high: float
) -> None:
    flight = FlightSpec(altitude_relative_m=altitude, minimum_altitude_relative_m=low, maximum_altitude_relative_m=high)
    limits = replace(LIMITS, flight=flight)
    outside = not low - 0.5 <= altitude <= high + 0.5
    start = kinds(start_vetoes(limits, situation(in_air=False)))
    place = kinds(place_vetoes(limits, situation(), FRAME.to_geo(50, 100), limits.home_amsl_m + altitude))
    assert (safety.AltitudeOutside in start) == outside
    assert (safety.AltitudeOutside in place) == outside


def test_a_vehicle_that_a_pilot_landed_and_disarmed_may_start_again_an_armed_one_may_not() -> None:
    assert start_vetoes(LIMITS, situation(in_air=False, armed=False, authority=PILOT)) == ()
    assert start_vetoes(LIMITS, situation(in_air=False, armed=True, authority=PILOT)) == (safety.PilotControls(),)


def test_resuming_is_vetoed_until_the_pilot_has_given_back_unless_it_is_the_failsafe() -> None:
    assert resume_vetoes(telemetry(authority=GIVEN_BACK, mode="HOLD")) == ()
    assert resume_vetoes(telemetry()) == ()
    assert resume_vetoes(telemetry(authority=FAILSAFE, mode="RETURN")) == ()
    assert resume_vetoes(telemetry(authority=PILOT, mode="RETURN")) == (safety.NotGivenBack("RETURN"),)


def test_a_pilot_whose_switch_our_order_undid_is_not_asked_to_select_the_mode_that_the_vehicle_is_in() -> None:
    undone = replace(PILOT, undone=True)
    assert resume_vetoes(telemetry(authority=undone, mode="BRAKE")) == (SwitchUndone("BRAKE"),)


def test_a_vehicle_in_the_air_stays_only_within_limits_that_hold_its_home_too() -> None:
    assert staying_vetoes(LIMITS, situation(east=60.0, north=50.0)) == ()
    away = replace(LIMITS, fence=box(200, 0, 400, 200))
    home, vehicle = staying_vetoes(away, situation(east=60.0, north=50.0))
    assert isinstance(home, safety.OutsideFence)
    assert isinstance(vehicle, safety.OutsideFence)
    assert (home.what, vehicle.what) == ("home", "vehicle")
    zone = replace(LIMITS, no_fly=(box(-9, -9, 9, 9),))
    assert staying_vetoes(zone, situation(east=60.0, north=50.0)) == (safety.InsideNoFly("home"),)


def test_an_area_that_leaves_no_way_home_is_not_gone_into() -> None:
    wall = box(100, -60, 150, 210)
    walled = replace(LIMITS, no_fly=(wall,), problem=airspace(FENCE, wall))
    assert kinds(staying_vetoes(walled, situation(east=300.0))) == [safety.NoWayHome]
    assert staying_vetoes(walled, situation(east=50.0)) == ()


def test_a_way_home_may_leave_the_zone_it_begins_in_and_enter_no_other() -> None:
    inside = situation(east=105.0, north=50.0)
    assert return_vetoes(LIMITS, inside, [(96.0, 50.0), (0.0, 0.0)], 140.0) == ()
    assert kinds(return_vetoes(LIMITS, inside, [(160.0, 50.0), (0.0, 0.0)], 140.0)) == [safety.WayCrossesNoFly]
    assert kinds(return_vetoes(LIMITS, situation(east=200.0, north=9.0), [(0.0, 9.0)], 140.0)) == [
        safety.WayCrossesNoFly
    ]
    another = replace(LIMITS, no_fly=(ZONE, box(80, 0, 100, 100)))
    assert kinds(return_vetoes(another, inside, [(70.0, 50.0), (0.0, 0.0)], 140.0)) == [safety.WayCrossesNoFly]


def test_a_way_home_begins_outside_the_fence_and_stays_inside_it_then() -> None:
    outside = situation(east=430.0, north=150.0)
    assert return_vetoes(LIMITS, outside, [(399.0, 150.0), (153.0, 103.0), (0.0, 105.0), (0.0, 0.0)], 140.0) == ()
    assert kinds(return_vetoes(LIMITS, outside, [(399.0, 150.0), (200.0, 220.0), (0.0, 105.0)], 140.0)) == [
        safety.WayLeavesFence
    ]


def test_a_way_home_lies_in_the_band_and_asks_for_no_battery() -> None:
    here = situation(east=50.0, battery_percent=1.0)
    assert return_vetoes(LIMITS, here, [(0.0, 0.0)], 140.0) == ()
    assert kinds(return_vetoes(LIMITS, here, [(0.0, 0.0)], 100.0 + 121.0)) == [safety.AltitudeOutside]
    assert kinds(return_vetoes(LIMITS, situation(east=50.0, authority=PILOT), [(0.0, 0.0)], 140.0)) == [
        safety.PilotControls
    ]


def test_a_place_may_be_judged_without_a_vehicle() -> None:
    assert standing_vetoes(LIMITS, FRAME.to_geo(50, 100), 140.0) == ()
    assert kinds(standing_vetoes(LIMITS, FRAME.to_geo(500, 0), 140.0)) == [safety.OutsideFence]


def test_every_veto_says_how_to_mend_it() -> None:
    bad = Situation(telemetry(north=50.0, authority=PILOT, battery_percent=5.0), now_s=2000.0)
    vetoes = place_vetoes(LIMITS, bad, FRAME.to_geo(500, 0), 500.0)
    assert len(vetoes) >= 4
    for veto in vetoes:
        assert remedy_of(veto)


@pytest.mark.parametrize(("charge", "stage"), [(90.0, "return"), (33.0, "return"), (18.0, "last"), (9.0, "land")])
def test_a_battery_is_the_lower_the_less_it_leaves(charge: float, stage: str) -> None:
    """Hovering over a place from which the way home takes 6.4 %, and the landing here 4.8 %."""
    seen = Situation(telemetry(0.0, 100.0, battery_percent=charge, altitude_relative_m=40.0), 1000.0, still_air(0.07))
    assert battery_stage(LIMITS, seen) == stage


def test_above_home_a_battery_is_never_so_low_that_it_lands_elsewhere() -> None:
    seen = Situation(telemetry(0.0, 2.0, battery_percent=3.0, altitude_relative_m=40.0), 1000.0, still_air(0.07))
    assert battery_stage(LIMITS, seen) == "last"


def test_without_terrain_the_band_alone_holds() -> None:
    low = replace(LIMITS, flight=FlightSpec(altitude_relative_m=12.0))
    assert kinds(place_vetoes(low, situation(), FRAME.to_geo(50, 100), 112.0)) == []


def test_a_turn_that_no_battery_lasts_for_is_refused_in_its_own_words() -> None:
    """Another battery mends nothing then."""
    nine_minutes = replace(LIMITS, measurement_time_s=540.0)
    (veto,) = start_vetoes(nine_minutes, situation(in_air=False, battery_percent=100.0))
    assert isinstance(veto, safety.TurnBeyondBattery)
    assert veto.turn_s == 540.0
    assert veto.takes_percent + veto.needed_percent + veto.reserve_percent > 100.0
    assert kinds(start_vetoes(LIMITS, situation(in_air=False, battery_percent=26.0))) == [safety.BatteryShort]


def test_a_battery_lasts_for_turns_that_fit_beside_the_ways_and_the_reserve() -> None:
    calm, minute = still_air(0.05), replace(LIMITS, measurement_time_s=60.0)
    middle = np.vstack(LIMITS.problem.area).mean(axis=0)
    assert lasts_for(100.0, minute, calm, 18, middle)
    assert not lasts_for(100.0, minute, calm, 26, middle), "25 of 3 % each, and neither way nor reserve"
    assert not lasts_for(50.0, minute, calm, 18, middle)
    assert not lasts_for(100.0, minute, calm, 18, middle + 2_000.0)
    assert not lasts_for(100.0, replace(minute, reserve_percent=90.0), calm, 2, middle)
    assert not lasts_for(100.0, replace(LIMITS, measurement_time_s=540.0), unknown(), 2, middle), "a beacon's bursts"
    assert lasts_for(100.0, replace(LIMITS, measurement_time_s=46.0), unknown(), 2, middle), "a tag's pulses"
