from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import box

from backend.mission.safety import (
    EDGE_TOLERANCE_M,
    LANDING_S,
    Limits,
    Situation,
    battery_to_return_percent,
    place_vetoes,
    resume_vetoes,
    start_vetoes,
    turn_vetoes,
    vehicle_vetoes,
)
from hardware.frame import LocalFrame
from hardware.readings import GeoPoint, Telemetry

HOME = GeoPoint(50.0, 7.0)
FRAME = LocalFrame(HOME)
LIMITS = Limits(
    frame=FRAME,
    fence=box(-50, -50, 400, 200),
    no_fly=(box(100, 0, 150, 100),),
    minimum_altitude_relative_m=10.0,
    maximum_altitude_relative_m=120.0,
    home_amsl_m=100.0,
    reserve_percent=25.0,
    battery_telemetry=True,
    speed_m_s=7.0,
    measurement_time_s=30.0,
)


def telemetry(east: float = 0.0, north: float = 0.0, **more: object) -> Telemetry:
    return replace(
        Telemetry(connected=True, at_s=1000.0, position=FRAME.to_geo(east, north), position_at_s=1000.0),
        **{"battery_percent": 90.0, "controller": "crossfix", "in_air": True, **more},  # type: ignore[arg-type]
    )


def situation(**more: object) -> Situation:
    return Situation(telemetry(**more), now_s=1000.5)  # type: ignore[arg-type]


def rules(east: float, north: float, seen: Situation, amsl: float = 140.0) -> list[str]:
    return [v.rule for v in place_vetoes(LIMITS, seen, FRAME.to_geo(east, north), amsl)]


def test_a_good_place_is_allowed() -> None:
    assert rules(50, 100, situation()) == []


@pytest.mark.parametrize(
    ("east", "north", "rule"),
    [(500, 0, "fence"), (-80, 0, "fence"), (120, 50, "no_fly"), (200, 50, "no_fly"), (9_000, 0, "distance")],
)
def test_places_outside_inside_a_zone_or_behind_one_are_refused(east: float, north: float, rule: str) -> None:
    assert rules(east, north, situation(north=50.0)) == [rule]


@pytest.mark.parametrize(("east", "refused"), [(99.0, True), (97.5, False), (151.0, True), (153.0, False)])
def test_a_place_beside_a_zone_is_refused_where_a_hovering_vehicle_would_wander_into_it(
    east: float, refused: bool
) -> None:
    here = situation(east=east - math.copysign(1.0, 125.0 - east), north=50.0)
    found = place_vetoes(LIMITS, here, FRAME.to_geo(east, 50.0), 140.0)
    assert [veto.rule for veto in found] == ["no_fly"] * refused
    assert all("1.0 m from a no-fly zone" in veto.detail for veto in found)


@pytest.mark.parametrize("east", [99.999_999, 100.0, 100.000_001])
def test_a_place_on_the_border_of_a_zone_is_refused_once(east: float) -> None:
    assert rules(east, 50.0, situation(east=90.0, north=50.0)) == ["no_fly"]


@pytest.mark.parametrize(("inside", "rule"), [(0.5 * EDGE_TOLERANCE_M, []), (2.0 * EDGE_TOLERANCE_M, ["no_fly"])])
def test_a_vehicle_that_wandered_into_a_zone_may_fly_out_of_it(inside: float, rule: list[str]) -> None:
    assert rules(50, 50, situation(east=100.0 + inside, north=50.0)) == rule


def test_the_way_may_not_leave_a_fence_that_is_not_convex() -> None:
    bent = replace(LIMITS, fence=box(0, 0, 20, 200).union(box(0, 0, 200, 20)), no_fly=())
    seen = situation(east=10.0, north=190.0)
    assert [v.rule for v in place_vetoes(bent, seen, FRAME.to_geo(190, 10), 140.0)] == ["fence"]
    assert place_vetoes(bent, seen, FRAME.to_geo(10, 10), 140.0) == ()


@pytest.mark.parametrize(("amsl", "allowed"), [(105.0, False), (111.0, True), (219.0, True), (225.0, False)])
def test_the_altitude_band_is_above_home(amsl: float, allowed: bool) -> None:
    assert (rules(50, 100, situation(), amsl) == []) is allowed


def test_the_pilot_a_lost_link_and_an_old_position_veto_everything() -> None:
    for seen, rule in (
        (situation(controller="pilot"), "pilot"),
        (situation(connected=False), "link"),
        (Situation(telemetry(), now_s=1010.0), "position"),
        (situation(position_at_s=None), "position"),
    ):
        assert [v.rule for v in vehicle_vetoes(seen)] == [rule]
        for vetoes in (
            start_vetoes(LIMITS, replace(seen)),
            turn_vetoes(LIMITS, seen),
            place_vetoes(LIMITS, seen, HOME, 140.0),
        ):
            assert rule in [v.rule for v in vetoes]


def test_a_battery_that_is_not_known_vetoes_unless_the_mission_says_that_it_never_is() -> None:
    unknown = situation(battery_percent=None)
    assert [v.rule for v in turn_vetoes(LIMITS, unknown)] == ["battery_unknown"]
    assert [v.rule for v in start_vetoes(LIMITS, situation(battery_percent=None, in_air=False))] == ["battery_unknown"]
    assert rules(50, 100, unknown) == ["battery_unknown"]
    assert turn_vetoes(replace(LIMITS, battery_telemetry=False), unknown) == ()


def test_a_battery_that_fell_silent_vetoes() -> None:
    assert turn_vetoes(LIMITS, situation(battery_at_s=990.0)) == ()
    assert [v.rule for v in turn_vetoes(LIMITS, situation(battery_at_s=960.0))] == ["battery_stale"]


@given(charge=st.floats(0, 100), east=st.floats(-40, 390), north=st.floats(110, 190), drain=st.floats(0.01, 1.0))
def test_whatever_is_allowed_leaves_the_way_home_and_the_reserve(
    charge: float, east: float, north: float, drain: float
) -> None:
    seen = Situation(telemetry(0.0, 150.0, battery_percent=charge), 1000.0, drain)
    place = FRAME.to_geo(east, north)
    vetoed = "battery" in [v.rule for v in place_vetoes(LIMITS, seen, place, 140.0)]
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
    assert [v.rule for v in start_vetoes(LIMITS, situation(in_air=True))] == ["ground"]
    outside = start_vetoes(LIMITS, situation(in_air=False, east=-50.0 - 30.0))
    assert [v.rule for v in outside] == ["fence"]
    assert "30 m outside" in outside[0].detail
    drifted = situation(in_air=False, east=-50.0 - 0.5 * EDGE_TOLERANCE_M)
    assert start_vetoes(LIMITS, drifted) == ()


def test_a_vehicle_that_a_pilot_landed_and_disarmed_may_start_again_an_armed_one_may_not() -> None:
    assert start_vetoes(LIMITS, situation(in_air=False, armed=False, controller="pilot")) == ()
    assert [v.rule for v in start_vetoes(LIMITS, situation(in_air=False, armed=True, controller="pilot"))] == ["pilot"]


def test_resuming_is_vetoed_until_the_pilot_has_given_back_unless_it_is_the_failsafe_that_was_found() -> None:
    assert resume_vetoes(telemetry(controller="pilot", mode="HOLD")) == ()
    assert resume_vetoes(telemetry()) == ()
    held = telemetry(controller="pilot", mode="RETURN", held_by_pilot=True)
    (veto,) = resume_vetoes(held)
    assert "RETURN" in veto.detail
    assert "HOLD" in veto.remedy
    assert resume_vetoes(held, tolerated_mode="RETURN") == ()
    assert resume_vetoes(held, tolerated_mode="LAND") == (veto,)


def test_every_veto_says_how_to_mend_it() -> None:
    bad = Situation(telemetry(north=50.0, controller="pilot", battery_percent=5.0), now_s=2000.0)
    for veto in place_vetoes(LIMITS, bad, FRAME.to_geo(500, 0), 500.0):
        assert veto.detail
        assert veto.remedy
