"""What the vehicle does when the pilot strikes: it turns, flies, brakes, takes off, returns, or is ordered a mode.

stay: it brakes for a hold, and the order to stay that follows once it is slow meets the strike (PX4 only).
"""

from __future__ import annotations

import asyncio
import math
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
    "turn",
    "flight",
    "stay",
    "take_off",
    "return",
    "hold ordered",
    "return ordered",
    "landing ordered",
    "steering ordered",
]
SCENES: tuple[Scene, ...] = get_args(Scene)
ORDERS: tuple[Scene, ...] = ("hold ordered", "return ordered", "landing ordered", "steering ordered")
"""The strike meets an order that has to select a mode. It is obeyed in every mode, the last one wins: it may undo the
pilot's, and then must be noticed."""
MANOEUVRES: tuple[Scene, ...] = tuple(scene for scene in SCENES if scene not in ORDERS)
MOMENTS: dict[Scene, tuple[Moment, ...]] = {
    "turn": ("crossing", "before", "crossing", "under way"),
    "flight": ("crossing", "before", "crossing", "under way"),
    "stay": ("crossing", "before"),
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
    "stay": frozenset({REPOSITION}),
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
FAST_M_S, NEARLY_SLOW_M_S = 4.0, 0.9
"""Of a flight when its hold is ordered, and a moment before the order to stay follows."""
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
    by_nobody: list[str] = field(default_factory=list[str])
    _legs: list[asyncio.Task[None]] = field(default_factory=list[asyncio.Task[None]])

    async def strike(self, scene: Scene, moment: Moment, means: Means) -> Outcome:
        """Raises TimeoutError or VehicleError when the scene does not come about."""
        try:
            await self._prepare(scene)
        finally:
            taken = self._look_for_takeover_by_nobody(scene)
        if taken:
            raise TimeoutError(f"somebody else has it: {self.by_nobody[-1]}")
        aim = Aim(self.proxy, self.pilot, means, self.chance)
        if moment == "before" and scene != "stay":
            aim.after(0.0)
            await asyncio.sleep(self.chance.uniform(0.0, self.proxy.delay_s + REPORT_S))
        elif moment == "crossing" and scene in ORDERS and self.pilot.believed_s:
            # the order is to arrive when the switch is obeyed, or before the news of it can be here
            aim.after(0.0)
            lead_s = self.pilot.believed_s - self.proxy.delay_s
            await asyncio.sleep(max(0.0, lead_s + self.chance.uniform(-LOOP_S, self.proxy.delay_s + LOOP_S)))
        elif moment == "crossing":
            aim.at_command(COMMANDS[scene], self._skipped(scene))
        doing = asyncio.create_task(self._do(scene))
        try:
            if moment == "under way":
                await self._under_way(scene, doing)
                aim.after(self.chance.uniform(0.0, 3.0))
            if moment == "before" and scene == "stay":
                await until(lambda: self._speed() < NEARLY_SLOW_M_S, 20.0, "the braking")
                aim.after(self.chance.uniform(0.0, REPORT_S))
            if not await _first(aim.fired, doing, 40.0):
                raise TimeoutError(f"nothing to aim at, {_ended(doing)}")
            return await watch(aim, self.proxy, self.pilot, self.vehicle, scene, moment, means)
        finally:
            self.proxy.on_sent = None
            doing.cancel()
            await asyncio.gather(doing, *self._legs, return_exceptions=True)
            self._legs.clear()
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
            case "stay":
                await self.vehicle.goto(self._spot(), self._amsl(), SPEED_M_S)
                leg = asyncio.create_task(self.vehicle.goto(self._place(), self._amsl(), SPEED_M_S))
                self._legs.append(leg)
                await until(lambda: leg.done() or self._speed() > FAST_M_S, 30.0, "the speed")
            case _:
                await self.vehicle.hold()

    def _skipped(self, scene: Scene) -> int:
        """Of the commands that count for a scene, how many pass before the one that is aimed at."""
        return {"turn": self.chance.randrange(4), "stay": 2}.get(scene, 0)

    def _speed(self) -> float:
        telemetry = self.vehicle.telemetry()
        return math.hypot(telemetry.velocity_north_m_s or 0.0, telemetry.velocity_east_m_s or 0.0)

    def _do(self, scene: Scene) -> Coroutine[Any, Any, None]:
        match scene:
            case "turn":
                return self.vehicle.turn(RATE_DEG_S)
            case "flight" | "steering ordered":
                return self.vehicle.goto(self._place(), self._amsl(), SPEED_M_S)
            case "take_off":
                return self.vehicle.take_off(HEIGHT_M)
            case "return" | "return ordered":
                return self.vehicle.return_home()
            case "stay" | "hold ordered":
                return self.vehicle.hold()
            case "landing ordered":
                return self.vehicle.land()

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

    def _look_for_takeover_by_nobody(self, scene: Scene) -> bool:
        """A vehicle that the autopilot's failsafe flies is not in the scene: an order would have to select a mode."""
        authority = self.vehicle.telemetry().authority
        if authority.taken_by is None:
            return False
        self.by_nobody.append(f"before {scene}, by {authority.taken_by}: {authority.mode}")
        self.vehicle.take_control()
        return True

    def _place(self) -> Place:
        """On the other side of home, east or west."""
        home = self.vehicle.telemetry().home
        assert home is not None
        frame = LocalFrame(home)
        return frame.to_geo(-60.0 if frame.to_enu(self._spot())[0] > 0.0 else 60.0, 20.0)

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
