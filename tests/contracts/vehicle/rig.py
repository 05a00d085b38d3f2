"""What every Vehicle must do, on every adapter: the two simulated autopilots, and a real one when its URL is given.

CROSSFIX_TEST_VEHICLE=udpin://0.0.0.0:14540 flies the real (or software-in-the-loop) autopilot behind that URL: it takes
off, flies some 40 m around its home at 15 m and lands. Keep clear. What needs a simulated pilot is then skipped.
"""

from __future__ import annotations

import asyncio
import math
import os
from collections.abc import Callable
from dataclasses import dataclass, field

import pytest

from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.clock import ScaledClock
from hardware.frame import LocalFrame
from hardware.ports import Vehicle
from hardware.readings import Place
from hardware.reasons.vehicle import VehicleReason
from hardware.reasons.vehicle_news import TriedAgain, VehicleNews
from hardware.sim.autopilot.launch import SimulatedAutopilot

REAL_URL = os.environ.get("CROSSFIX_TEST_VEHICLE")
SPEEDUP = 16.0
HEIGHT = 15.0
FLIGHT_COMMANDS = {20, 21, 22, 115, 176, 178, 192, 400}
DEAD_STATION = {"sim-px4": ("NAV_DLL_ACT", "RETURN"), "sim-ardupilot": ("FS_GCS_ENABLE", "RTL")}


@dataclass
class Rig:
    """One vehicle under test with its clock; `autopilot` None when it is a real one."""

    name: str
    vehicle: MavsdkVehicle
    clock: ScaledClock
    autopilot: SimulatedAutopilot | None
    news: list[VehicleNews] = field(default_factory=list[VehicleNews])

    @property
    def sim(self) -> SimulatedAutopilot:
        if self.autopilot is None:
            pytest.skip("needs the simulated autopilot's pilot and faults")
        return self.autopilot

    def tried_again(self) -> list[VehicleReason]:
        """Why, each time."""
        return [news.because for news in self.news if isinstance(news, TriedAgain)]

    async def until(self, happened: Callable[[], bool], seconds: float, what: str) -> None:
        end = self.clock.now() + seconds
        while not happened():
            assert self.clock.now() < end, f"{what} did not happen within {seconds} s: {self.vehicle.telemetry()}"
            await self.clock.sleep(0.1)

    def place(self, east: float, north: float) -> Place:
        """Metres from home."""
        home = self.vehicle.telemetry().home
        assert home is not None
        return LocalFrame(home).to_geo(east, north)

    def amsl(self) -> float:
        home = self.vehicle.telemetry().home_amsl_m
        assert home is not None
        return home + HEIGHT

    def off_by(self, place: Place) -> float:
        position = self.vehicle.telemetry().position
        assert position is not None
        return math.hypot(*LocalFrame(place).to_enu(position))

    async def airborne(self) -> None:
        if not self.vehicle.telemetry().in_air:
            await self.vehicle.take_off(HEIGHT)


async def ready(vehicle: Vehicle, clock: ScaledClock) -> None:
    """Wait as an operator would until the vehicle is ready (failsafe parameters do not mend themselves)."""
    for _ in range(60):
        checks = await vehicle.preflight()
        if all(check.ok for check in checks if check.blocking and check.name != "failsafe"):
            return
        await clock.sleep(1.0)


async def ends_with(task: asyncio.Task[None], error: type[BaseException], says: str | None = None) -> None:
    with pytest.raises(error, match=says):
        await asyncio.wait_for(task, 60)
