from __future__ import annotations

import math
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.sim.autopilot.copter import Airframe, Copter, Demand, Wind

DT = 0.02


def airborne(wind: Wind | None = None, seed: int = 1) -> Copter:
    copter = Copter(Airframe(), wind or Wind(), Random(seed))
    copter.up = 40.0
    return copter


@settings(max_examples=25, deadline=None)
@given(st.floats(-150, 150), st.floats(-150, 150), st.floats(10, 80), st.floats(1, 12), st.floats(-720, 720))
def test_it_arrives_within_its_limits(north: float, east: float, up: float, speed: float, heading: float) -> None:
    copter, demand = airborne(), Demand(north, east, up, heading, speed=speed, yaw_rate_limit=45.0)
    fastest = turning = pushing = 0.0
    for _ in range(int((math.hypot(north, east) / speed + abs(heading) / 45 + 60) / DT)):
        before = copter.v_north, copter.v_east
        copter.step(DT, demand)
        fastest = max(fastest, math.hypot(copter.v_north, copter.v_east))
        turning = max(turning, abs(copter.yaw_rate))
        pushing = max(pushing, math.hypot(copter.v_north - before[0], copter.v_east - before[1]) / DT)

    assert math.dist((copter.north, copter.east, copter.up), (north, east, up)) < 0.3
    assert copter.heading == pytest.approx(heading, abs=0.5)
    assert fastest <= speed + 1e-6
    assert turning <= 45.0 + 1e-6
    assert pushing <= copter.airframe.acceleration + 1e-6


def test_gusts_shake_it_and_the_controller_holds_the_place() -> None:
    copter, demand = airborne(Wind(6.0, 270.0, 3.0)), Demand(0.0, 0.0, 40.0, 0.0)
    offsets = []
    for _ in range(int(120 / DT)):
        copter.step(DT, demand)
        offsets.append(math.hypot(copter.north, copter.east))

    assert 0.2 < max(offsets) < 2.0


def test_the_same_seed_flies_the_same_path_and_another_does_not() -> None:
    def fly(seed: int) -> tuple[float, float]:
        copter = airborne(Wind(6.0, 270.0, 3.0), seed)
        for _ in range(500):
            copter.step(DT, Demand(50.0, 0.0, 40.0, 0.0))
        return copter.north, copter.east

    assert fly(3) == fly(3)
    assert fly(3) != fly(4)


def test_the_battery_lasts_about_twenty_minutes_and_less_against_the_wind() -> None:
    def endurance(wind: Wind) -> float:
        copter, time = airborne(wind), 0.0
        while copter.battery_percent > 0.0 and time < 3600.0:
            copter.step(0.1, Demand(0.0, 0.0, 40.0, 0.0))
            time += 0.1
        return time / 60.0

    calm = endurance(Wind())
    assert 18.0 < calm < 28.0
    assert endurance(Wind(10.0, 0.0)) < calm - 1.0


def test_it_acts_on_what_its_navigation_believes() -> None:
    copter = airborne()
    for _ in range(1500):
        copter.step(DT, Demand(0.0, 0.0, 40.0, 0.0), error=(10.0, 0.0, 0.0))

    assert copter.north == pytest.approx(-10.0, abs=0.3)


def test_without_motors_it_falls_and_stays_on_the_ground() -> None:
    copter = airborne()
    for _ in range(500):
        copter.step(DT, None)

    assert copter.on_ground
    assert (copter.up, copter.v_up) == (0.0, 0.0)


def test_twenty_simulated_minutes_are_no_burden() -> None:
    """60,000 steps: bounded in steps, not in wall time; the report has the measured seconds."""
    copter = airborne(Wind(5.0, 90.0, 2.0))
    for _ in range(60_000):
        copter.step(DT, Demand(0.0, 0.0, 40.0, 0.0))

    assert math.hypot(copter.north, copter.east) < 3.0


def flown(wind: Wind, north: float = 400.0, seconds: float = 60.0) -> tuple[Copter, float]:
    """(the body, Wh it used) after so long towards a place in the north."""
    copter = airborne(wind)
    full = copter.energy
    for _ in range(int(seconds / DT)):
        copter.step(DT, Demand(north, 0.0, 40.0, 0.0, speed=7.0))
    return copter, full - copter.energy


def test_against_the_wind_it_takes_more_and_flies_no_faster_than_its_airspeed() -> None:
    still, without = flown(Wind())
    against, with_wind = flown(Wind(6.5, 0.0))
    assert against.north == pytest.approx(still.north, abs=1.0)
    assert with_wind > 1.5 * without
    stormy, _ = flown(Wind(11.0, 0.0))
    assert stormy.north == pytest.approx(60.0 * 3.0, rel=0.05)
    carried, _ = flown(Wind(16.0, 0.0), north=0.0)
    assert carried.north == pytest.approx(-60.0 * 2.0, rel=0.05)


def test_it_leans_into_the_wind_and_more_when_it_flies_against_it() -> None:
    hovering, _ = flown(Wind(6.0, 0.0), north=0.0)
    flying, _ = flown(Wind(6.0, 0.0), seconds=20.0)
    assert 0.0 < hovering.push_north < flying.push_north
    assert hovering.push_east == pytest.approx(0.0, abs=0.01)
