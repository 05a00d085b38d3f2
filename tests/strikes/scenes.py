"""What the vehicle does when the pilot strikes: it turns, flies, takes off or returns; or is ordered another mode."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Coroutine
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

from hardware.autopilot.messages import CONDITION_YAW, REPOSITION, SET_MODE, TAKE_OFF
from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.frame import LocalFrame
from hardware.readings import Place
from tests.strikes.pilot import Pilot
from tests.strikes.proxy import Proxy
from tests.strikes.strike import REPORT_S, Aim, Means, Moment, Outcome, until, watch

Scene = Literal[
    "turn", "flight", "take_off", "return", "hold ordered", "return ordered", "landing ordered", "steering ordered"
]
SCENES: tuple[Scene, ...] = get_args(Scene)
ORDERS: tuple[Scene, ...] = ("hold ordered", "return ordered", "landing ordered", "steering ordered")
"""The strike meets an order that has to select a mode. It is obeyed in every mode, the last one wins: it may undo the
pilot's, and then must be noticed."""
MANOEUVRES: tuple[Scene, ...] = tuple(scene for scene in SCENES if scene not in ORDERS)
MOMENTS: dict[Scene, tuple[Moment, ...]] = {
    "turn": ("crossing", "before", "crossing", "under way"),
    "flight": ("crossing", "before", "crossing", "under way"),
    "take_off": ("under way",),
    "return": ("under way",),
    "hold ordered": ("crossing",),
    "return ordered": ("crossing",),
    "landing ordered": ("crossing",),
    "steering ordered": ("crossing",),
}
"""Taken in turn."""
COMMANDS: dict[Scene, frozenset[int]] = {
    "turn": frozenset({REPOSITION, CONDITION_YAW}),
    "flight": frozenset({REPOSITION}),
    "take_off": frozenset({TAKE_OFF}),
    "return": frozenset({SET_MODE}),
    "hold ordered": frozenset({SET_MODE, REPOSITION}),
    "return ordered": frozenset({SET_MODE}),
    "landing ordered": frozenset({SET_MODE}),
    "steering ordered": frozenset({SET_MODE}),
}
HEIGHT_M = 12.0
SPEED_M_S = 5.0
RATE_DEG_S = 30.0
LOOP_S = 0.05
"""Of an autopilot and its radio, and a little more."""


@dataclass
class Field:
    """The vehicle under test, reached through the proxy, and its pilot.

    by_nobody: takeovers that were told while the pilot's hands were off, in words.
    """

    vehicle: MavsdkVehicle
    proxy: Proxy
    pilot: Pilot
    chance: random.Random
    flown: int = 0
    by_nobody: list[str] = field(default_factory=list[str])

    async def strike(self, scene: Scene, moment: Moment, means: Means) -> Outcome:
        """Raises TimeoutError or VehicleError when the scene does not come about."""
        try:
            await self._prepare(scene)
        finally:
            self._look_for_takeover_by_nobody(scene)
        aim = Aim(self.proxy, self.pilot, means, self.chance)
        if moment == "before":
            aim.after(0.0)
            await asyncio.sleep(self.chance.uniform(0.0, self.proxy.delay_s + REPORT_S))
        elif moment == "crossing" and scene in ORDERS and self.pilot.believed_s:
            # the order is to arrive when the switch is obeyed, or before the news of it can be here
            aim.after(0.0)
            lead_s = self.pilot.believed_s - self.proxy.delay_s
            await asyncio.sleep(max(0.0, lead_s + self.chance.uniform(-LOOP_S, self.proxy.delay_s + LOOP_S)))
        elif moment == "crossing":
            aim.at_command(COMMANDS[scene], self.chance.randrange(4) if scene == "turn" else 0)
        doing = asyncio.create_task(self._do(scene))
        try:
            if moment == "under way":
                await self._under_way(scene, doing)
                aim.after(self.chance.uniform(0.0, 3.0))
            if not await _first(aim.fired, doing, 40.0):
                raise TimeoutError(f"nothing to aim at, {_ended(doing)}")
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
        if telemetry().authority.undone:  # it shows the waiting mode already: that gives nothing back
            if self.pilot.believed_s:  # a switch that stays where it is selects nothing
                self.pilot.give_back()
                await asyncio.sleep(2.0 * self.pilot.believed_s)
            self.pilot.take_by_mode()
            await asyncio.sleep(2.0 * self.proxy.delay_s + 2.0)
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
            self.pilot.on_the_ground()
            return
        if not telemetry().in_air:
            self.pilot.on_the_ground()
            await self.vehicle.take_off(HEIGHT_M)
        match scene:
            case "hold ordered":
                await self.vehicle.return_home()
            case "flight" | "turn":  # in the mode that steers: ArduCopter has another one to hold
                await self.vehicle.goto(self._spot(), self._amsl(), SPEED_M_S)
            case _:
                await self.vehicle.hold()

    def _do(self, scene: Scene) -> Coroutine[Any, Any, None]:
        orders = {
            "turn": self.vehicle.turn(RATE_DEG_S),
            "flight": self.vehicle.goto(self._place(), self._amsl(), SPEED_M_S),
            "take_off": self.vehicle.take_off(HEIGHT_M),
            "return": self.vehicle.return_home(),
            "return ordered": self.vehicle.return_home(),
            "hold ordered": self.vehicle.hold(),
            "landing ordered": self.vehicle.land(),
            "steering ordered": self.vehicle.goto(self._place(), self._amsl(), SPEED_M_S),
        }
        for other, order in orders.items():
            if other != scene:
                order.close()
        return orders[scene]

    async def _under_way(self, scene: Scene, doing: asyncio.Task[None]) -> None:
        telemetry = self.vehicle.telemetry

        def climbs() -> bool:
            return (telemetry().altitude_relative_m or 0.0) > 1.5

        def returns() -> bool:
            return telemetry().mode in ("RETURN", "RTL")

        begun = {"take_off": climbs, "return": returns}.get(scene)
        if begun is not None:
            await until(lambda: begun() or (doing.done() and doing.exception() is not None), 60.0, f"the {scene}")
            if not begun():
                raise TimeoutError(_ended(doing))

    def _look_for_takeover_by_nobody(self, scene: Scene) -> None:
        authority = self.vehicle.telemetry().authority
        if authority.taken_by is not None:
            self.by_nobody.append(f"before {scene}, by {authority.taken_by}: {authority.mode}")
            self.vehicle.take_control()

    def _place(self) -> Place:
        """East and west of home in turn."""
        home = self.vehicle.telemetry().home
        assert home is not None
        self.flown += 1
        return LocalFrame(home).to_geo(60.0 if self.flown % 2 else -60.0, 20.0)

    def _spot(self) -> Place:
        """Where it is."""
        position = self.vehicle.telemetry().position
        assert position is not None
        return position

    def _amsl(self) -> float:
        home = self.vehicle.telemetry().home_amsl_m
        assert home is not None
        return home + HEIGHT_M


async def _first(fired: asyncio.Event, doing: asyncio.Task[None], seconds: float) -> bool:
    """True once it fired; False when the order failed before, or the time is up."""
    waiting = asyncio.create_task(fired.wait())
    try:
        async with asyncio.timeout(seconds):
            await asyncio.wait((waiting, doing), return_when=asyncio.FIRST_COMPLETED)
            if doing.done() and doing.exception() is not None and not fired.is_set():
                return False
            await waiting
            return True
    except TimeoutError:
        return False
    finally:
        waiting.cancel()


def _ended(doing: asyncio.Task[None]) -> str:
    """What became of the order, in words."""
    if not doing.done():
        return "the order is still being carried out"
    return "the order is done" if (error := doing.exception()) is None else f"the order failed: {error}"
