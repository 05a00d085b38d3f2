"""A battery that runs low while the craft is held in wind, over the vehicle adapter on a simulated autopilot."""

from __future__ import annotations

import math

import pytest
from equipment import FRAME, spec
from simulated_mission import HOME_FRAME, Flight, flight
from stepped_loop import run_stepped

from backend import commands
from backend.craft.low_battery import COUNTDOWN_S
from backend.reasons import PreflightFailed
from backend.reasons.refusals import NoCountdown
from backend.reasons.safety import FirstTurnBeyondBattery, FirstTurnBeyondCharge
from backend.spec import MissionSpec, Polygon
from hardware.sim.autopilot.copter import Wind
from hardware.sim.autopilot.firmware import Conditions
from hardware.sim.autopilot.px4 import Px4

WINDY = Conditions(HOME_FRAME, wind=Wind(6.0, 180.0, 0.5), battery_percent=55.0)
"""Against the way home."""
OWN_FAILSAFE_PERCENT = 7.0


async def held_with_a_low_battery(one: Flight) -> None:
    await one.start()
    await one.fly_to(0.0, 95.0)
    assert await one.order(commands.Hold()) is None
    await one.until(lambda: one.phase == "hold")
    await one.until(lambda: one.count("battery_countdown_started") == 1)
    assert one.phase == "hold"


async def brought_home(one: Flight) -> None:
    await one.until(lambda: not one.firmware.flight.armed)
    assert math.hypot(*one.track[-1][:2]) < 3.0
    assert one.firmware.copter.battery_percent > OWN_FAILSAFE_PERCENT
    assert one.count("battery_countdown_started") == 1


async def nobody_stops_it() -> None:
    async with flight(Px4(WINDY)) as one:
        await held_with_a_low_battery(one)
        began_s = one.stage.clock.now()
        await one.until(lambda: one.count("return_ordered") == 1)
        assert one.stage.clock.now() - began_s == pytest.approx(COUNTDOWN_S, abs=1.0)
        await brought_home(one)


def test_a_low_battery_in_hold_brings_the_craft_home_after_a_countdown() -> None:
    run_stepped(nobody_stops_it())


async def stopped_once() -> None:
    async with flight(Px4(WINDY)) as one:
        await held_with_a_low_battery(one)
        assert await one.order(commands.KeepHolding()) is None
        since = len(one.track)
        await one.stage.clock.sleep(COUNTDOWN_S + 2.0)
        assert (one.phase, one.firmware.mode, one.count("return_ordered")) == ("hold", "HOLD", 0)
        assert max(math.dist(at[:2], one.track[since][:2]) for at in one.track[since:]) < 3.0
        await one.until(lambda: one.count("return_ordered") == 1)
        assert isinstance(await one.order(commands.KeepHolding()), NoCountdown)
        await brought_home(one)


def test_the_countdown_is_stopped_once_and_lower_still_the_craft_returns_all_the_same() -> None:
    run_stepped(stopped_once())


def far_away(north_m: float) -> MissionSpec:
    """An area that begins so far north of home, in a fence that holds both."""
    mission = spec(fence=around(-140.0, -40.0, 140.0, north_m + 140.0))
    return mission.model_copy(update={"area": around(-100.0, north_m, 100.0, north_m + 100.0)})


def around(west: float, south: float, east: float, north: float) -> Polygon:
    ring = [(west, south), (east, south), (east, north), (west, north), (west, south)]
    return Polygon(coordinates=[[(p.lon, p.lat) for p in (FRAME.to_geo(x, y) for x, y in ring)]])


async def started(one: Flight, mission: MissionSpec) -> object:
    """Why it was refused, None when the craft takes off."""
    one.stage.publisher.consoles = 1
    one.mission_id = await one.stage.room.drafts.create(mission, "anna")
    return await one.order(commands.Start())


async def it_stays_on_the_ground() -> None:
    async with flight(Px4(Conditions(HOME_FRAME))) as one:
        refused = await started(one, far_away(800.0))
        assert isinstance(refused, PreflightFailed), "it took off, and its battery took it home at once"
        assert isinstance(refused.because, FirstTurnBeyondBattery)
        assert not one.firmware.flight.armed


def test_an_area_that_the_battery_does_not_reach_is_refused_before_the_take_off() -> None:
    run_stepped(it_stays_on_the_ground())


async def the_least_charge_turns() -> None:
    async with flight(Px4(Conditions(HOME_FRAME, battery_percent=66.0))) as one:
        mission = far_away(250.0)
        refused = await started(one, mission)
        assert isinstance(refused, PreflightFailed)
        assert isinstance(refused.because, FirstTurnBeyondCharge)
        short = refused.because
        enough = 1.0 + short.takes_percent + short.needed_percent + short.reserve_percent
        assert enough == pytest.approx(short.charge_percent, abs=2.0)
        one.firmware.copter.energy = one.firmware.copter.airframe.capacity * enough / 100.0
        await one.stage.clock.sleep(3.0)
        assert await started(one, mission) is None
        await one.until(lambda: one.count("sweep_started") == 1 or one.phase == "returning")
        await one.until(
            lambda: one.count("bearing_measured") + one.count("sweep_rejected") > 0 or one.phase != "measuring"
        )
        assert one.count("return_ordered") == 0
        assert one.count("place_reached") == 1


def test_a_charge_a_percent_above_what_is_refused_is_enough_to_turn_once() -> None:
    run_stepped(the_least_charge_turns())
