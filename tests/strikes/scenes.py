"""What the vehicle does when the pilot strikes: it turns, flies, takes off or returns."""

from __future__ import annotations

import asyncio
import contextlib
import random
from collections.abc import Coroutine
from dataclasses import dataclass
from typing import Any, Literal, get_args

from hardware.autopilot.messages import CONDITION_YAW, REPOSITION, SET_MODE, TAKE_OFF
from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.frame import LocalFrame
from hardware.ports import VehicleError
from hardware.readings import Place
from tests.strikes.pilot import Pilot
from tests.strikes.proxy import Proxy
from tests.strikes.strike import REPORT_S, Aim, Means, Moment, Outcome, until, watch

Scene = Literal["turn", "flight", "take_off", "return"]
SCENES: tuple[Scene, ...] = get_args(Scene)
MOMENTS: dict[Scene, tuple[Moment, ...]] = {
    "turn": ("crossing", "before", "crossing", "under way"),
    "flight": ("crossing", "before", "crossing", "under way"),
    "take_off": ("under way",),
    "return": ("under way",),
}
"""Taken in turn. No aim at orders of a mode (take-off, return): they are obeyed in every mode, the last one wins."""
COMMANDS: dict[Scene, frozenset[int]] = {
    "turn": frozenset({REPOSITION, CONDITION_YAW}),
    "flight": frozenset({REPOSITION}),
    "take_off": frozenset({TAKE_OFF}),
    "return": frozenset({SET_MODE}),
}
HEIGHT_M = 12.0
SPEED_M_S = 5.0
RATE_DEG_S = 30.0


@dataclass
class Field:
    """The vehicle under test, reached through the proxy, and its pilot."""

    vehicle: MavsdkVehicle
    proxy: Proxy
    pilot: Pilot
    chance: random.Random
    flown: int = 0

    async def strike(self, scene: Scene, moment: Moment, means: Means) -> Outcome:
        """Raises TimeoutError when the scene does not come about."""
        await self._prepare(scene)
        aim = Aim(self.proxy, self.pilot, means, self.chance)
        if moment == "before":
            aim.after(0.0)
            await asyncio.sleep(self.chance.uniform(0.0, self.proxy.delay_s + REPORT_S))
        elif moment == "crossing":
            aim.at_command(COMMANDS[scene], self.chance.randrange(6) if scene == "turn" else 0)
        doing = asyncio.create_task(self._do(scene))
        if moment == "under way":
            await self._under_way(scene)
            aim.after(self.chance.uniform(0.0, 3.0))
        try:
            async with asyncio.timeout(40.0):
                await aim.fired.wait()
            return await watch(aim, self.proxy, self.pilot, self.vehicle, scene, moment, means)
        finally:
            self.proxy.on_sent = None
            doing.cancel()
            await asyncio.gather(doing, return_exceptions=True)
            await self.give_back()

    async def give_back(self) -> None:
        """The pilot gives the vehicle back, the operator takes it: it hovers, or stands."""
        telemetry = self.vehicle.telemetry
        self.pilot.release_sticks()
        await asyncio.sleep(0.3)
        self.pilot.give_back()
        await asyncio.sleep(2.0 * self.proxy.delay_s + 0.5)
        if telemetry().authority.taken_by is not None:
            await until(lambda: telemetry().authority.given_back, 15.0, "the vehicle given back")
        self.vehicle.take_control()

    async def _prepare(self, scene: Scene) -> None:
        telemetry = self.vehicle.telemetry
        if scene == "take_off":
            if telemetry().in_air:
                await self.vehicle.land()
                await until(lambda: telemetry().armed is False, 120.0, "the landing")
            return
        if not telemetry().in_air:
            await self.vehicle.take_off(HEIGHT_M)
        if scene in ("return", "turn"):
            await self.vehicle.hold()

    def _do(self, scene: Scene) -> Coroutine[Any, Any, None]:
        orders = {
            "turn": self.vehicle.turn(RATE_DEG_S),
            "flight": self.vehicle.goto(self._place(), self._amsl(), SPEED_M_S),
            "take_off": self.vehicle.take_off(HEIGHT_M),
            "return": self.vehicle.return_home(),
        }
        for other, order in orders.items():
            if other != scene:
                order.close()
        return _unless_refused(orders[scene])

    async def _under_way(self, scene: Scene) -> None:
        telemetry = self.vehicle.telemetry
        if scene == "take_off":
            await until(lambda: (telemetry().altitude_relative_m or 0.0) > 1.5, 60.0, "the climb")
        if scene == "return":
            await until(lambda: telemetry().mode in ("RETURN", "RTL"), 15.0, "the return")

    def _place(self) -> Place:
        """East and west of home in turn."""
        home = self.vehicle.telemetry().home
        assert home is not None
        self.flown += 1
        return LocalFrame(home).to_geo(60.0 if self.flown % 2 else -60.0, 20.0)

    def _amsl(self) -> float:
        home = self.vehicle.telemetry().home_amsl_m
        assert home is not None
        return home + HEIGHT_M


async def _unless_refused(order: Coroutine[Any, Any, None]) -> None:
    with contextlib.suppress(VehicleError):
        await order
