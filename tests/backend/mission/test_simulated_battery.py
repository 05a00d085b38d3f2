"""A battery that runs low while the craft is held in wind, over the vehicle adapter on a simulated autopilot."""

from __future__ import annotations

import math

import pytest
from simulated_mission import HOME_FRAME, Flight, flight
from stepped_loop import run_stepped

from backend import commands
from backend.craft.low_battery import COUNTDOWN_S
from backend.reasons.refusals import NoCountdown
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
