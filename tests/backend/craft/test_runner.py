"""The craft's runner on doubles: each effect reaches the vehicle, the newest wins, and its result is given once."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from dataclasses import replace

import pytest
from craft_walk import CraftWalk
from equipment import FRAME, HOME, spec
from facts import FAILSAFE
from stage import Stage

from backend import commands
from backend.craft import effects, inputs
from backend.craft.runner import CraftRunner
from backend.reasons.flight import StepBroke, Way
from backend.reasons.safety import BatteryShort, NotGivenBack, OutsideFence
from backend.search.task import search_task
from backend.spec import Place
from hardware.reasons.vehicle import VehicleSilent

NEAR = FRAME.to_geo(20.0, 30.0)


class Rig:
    """A runner whose machine only listens. `given`: what came of its effects."""

    def __init__(self) -> None:
        self.stage = Stage()
        self.vehicle = self.stage.vehicle
        self.walk = CraftWalk(spec()).to("flying")
        self.given: list[inputs.CraftInput] = []
        self.runner = CraftRunner(
            "m",
            self.stage.craft(),
            search_task(spec(), HOME, 100.0),
            lambda: self.walk.craft,
            lambda: self.walk.search,
            self.given.append,
            lambda points: None,
            lambda found, place_number, attempt: None,
        )
        self.runner.listening.start()

    def flies(self) -> None:
        self.vehicle.state = replace(self.vehicle.state, armed=True, in_air=True, altitude_relative_m=40.0)

    async def until(self, happened: Callable[[], bool]) -> None:
        await self.stage.until_true(happened, 10.0)


@pytest.fixture
async def rig() -> AsyncIterator[Rig]:
    made = Rig()
    yield made
    await made.runner.close()


async def test_a_take_off_says_that_the_craft_is_in_the_air(rig: Rig) -> None:
    rig.runner.carry_out(effects.TakeOff(40.0))
    await rig.until(lambda: bool(rig.given))
    assert isinstance(rig.given[0], inputs.InTheAir)
    assert rig.vehicle.names == ["take_off"]


async def test_a_hold_cancels_what_runs_and_its_result_is_never_given(rig: Rig) -> None:
    rig.flies()
    rig.vehicle.stuck = True
    rig.runner.carry_out(effects.FlyTo(1, NEAR))
    await rig.until(lambda: rig.vehicle.names == ["goto"])
    rig.runner.carry_out(effects.CancelWork())
    rig.runner.carry_out(effects.HoldVehicle())
    rig.vehicle.stuck = False
    await rig.until(lambda: rig.vehicle.names == ["goto", "hold"])
    await asyncio.sleep(0.1)
    assert rig.given == [inputs.CarriedOut("hold")]


async def test_work_that_is_replaced_before_it_began_is_never_begun(rig: Rig) -> None:
    rig.flies()
    for _ in range(3):
        rig.runner.carry_out(effects.ReturnHome())
        rig.runner.carry_out(effects.HoldVehicle())
    await rig.until(lambda: bool(rig.vehicle.names))
    await asyncio.sleep(0.1)
    assert rig.vehicle.names == ["hold"]


async def test_safety_is_asked_again_right_before_the_flight(rig: Rig) -> None:
    rig.flies()
    rig.vehicle.state = replace(rig.vehicle.state, battery_percent=20.0)
    for effect in (effects.FlyTo(1, NEAR), effects.Measure(1, 1)):
        rig.given.clear()
        rig.runner.carry_out(effect)
        await rig.until(lambda: bool(rig.given))
        (vetoed,) = rig.given
        assert isinstance(vetoed, inputs.WorkVetoed)
        assert isinstance(vetoed.vetoes[0], BatteryShort)
    assert rig.vehicle.names == []


async def test_what_the_vehicle_was_told_is_carried_out_once_telemetry_shows_it(rig: Rig) -> None:
    rig.flies()
    told: dict[Way, effects.CraftEffect] = {
        "hold": effects.HoldVehicle(),
        "return": effects.ReturnHome(),
        "land": effects.Land(),
    }
    for way, effect in told.items():
        rig.runner.carry_out(effect)
        await rig.until(lambda way=way: rig.given == [inputs.CarriedOut(way)])
        rig.given.clear()
    assert rig.vehicle.names == ["hold", "land", "land"]


async def test_what_fails_is_given_with_its_reason_and_whether_the_vehicle_flies(rig: Rig) -> None:
    rig.flies()
    rig.vehicle.heard = False
    rig.runner.carry_out(effects.ReturnHome())
    await rig.until(lambda: bool(rig.given))
    (failed,) = rig.given
    assert isinstance(failed, inputs.WorkFailed)
    assert (failed.step, failed.in_air) == ("return", True)
    assert isinstance(failed.because, VehicleSilent)


async def test_a_fault_of_our_own_in_a_step_is_given_as_such(rig: Rig) -> None:
    async def broken() -> None:
        raise ZeroDivisionError

    rig.vehicle.hold = broken  # type: ignore[method-assign]
    rig.runner.carry_out(effects.HoldVehicle())
    await rig.until(lambda: bool(rig.given))
    assert rig.given == [inputs.WorkFailed("hold", StepBroke("hold"), in_air=False)]


async def test_a_vehicle_whose_failsafe_brings_it_home_or_that_stands_is_not_ordered_home(rig: Rig) -> None:
    for effect in (effects.ReturnHome(), effects.Land()):
        rig.runner.carry_out(effect)
        await asyncio.sleep(0.02)
    rig.flies()
    rig.vehicle.control.authority = FAILSAFE
    for effect in (effects.ReturnHome(), effects.Land()):
        rig.runner.carry_out(effect)
        await asyncio.sleep(0.02)
    assert rig.vehicle.names == []


async def test_a_timer_expires_once_and_a_cancelled_one_never(rig: Rig) -> None:
    rig.runner.carry_out(effects.StartTimer("console_hold", 0.01))
    rig.runner.carry_out(effects.StartTimer("console_return", 0.01))
    rig.runner.carry_out(effects.StartTimer("landing", 0.5))
    rig.runner.carry_out(effects.CancelTimer("console_return"))
    await rig.until(lambda: len(rig.given) == 2)
    await asyncio.sleep(0.05)
    assert set(rig.given) == {inputs.TimerExpired("console_hold"), inputs.TimerExpired("landing")}


async def test_what_safety_has_against_an_order_is_found_before_it_is_given(rig: Rig) -> None:
    rig.flies()
    far: Place = FRAME.to_geo(300.0, 0.0)
    (fence,) = rig.runner.objections(commands.Override(place=far))
    assert isinstance(fence, OutsideFence)
    assert rig.runner.objections(commands.Override(place=NEAR)) == ()
    rig.vehicle.shows("POSCTL")
    rig.vehicle.control.authority = replace(FAILSAFE, who="pilot", mode="POSCTL")
    assert rig.runner.objections(commands.Resume()) == (NotGivenBack("POSCTL"),)
    assert rig.runner.objections(commands.Hold()) == ()
