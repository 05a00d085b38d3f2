"""A mission room whose craft is the vehicle adapter on a simulated autopilot, all in the time of a SteppedLoop."""

from __future__ import annotations

import math
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field

from equipment import FRAME, HOME
from flights import flying, order
from relief import Shelf
from simulated_air import simulated
from stage import Stage

from backend import commands
from backend.events import Event, PhaseChanged
from backend.terrain import Terrain
from hardware.sim.autopilot.firmware import Command, Firmware
from hardware.sim.autopilot.geodesy import HomeFrame

HOME_FRAME = HomeFrame(HOME.lat, HOME.lon, 100.0)
LONGEST_S = 900.0
REPOSITION = 192
"""MAV_CMD."""


@dataclass
class Flight:
    """A room whose craft is simulated. track: (east, north, up) m from home, in truth, at each step."""

    stage: Stage
    firmware: Firmware
    track: list[tuple[float, float, float]] = field(default_factory=list[tuple[float, float, float]])
    sent_amsl_m: set[float] = field(default_factory=set[float])
    """With repositions, that the autopilot received."""
    mission_id: str = ""

    def __post_init__(self) -> None:
        obeyed = self.firmware.command

        def noted(command: Command) -> int | None:
            if command.number == REPOSITION and not math.isnan(command.z):
                self.sent_amsl_m.add(command.z)
            return obeyed(command)

        self.firmware.command = noted  # type: ignore[method-assign]

    def see(self, firmware: Firmware) -> None:
        copter = firmware.copter
        self.track.append((copter.east, copter.north, copter.up))

    async def until(self, happened: Callable[[], bool]) -> None:
        end_s = self.stage.clock.now() + LONGEST_S
        while not happened():
            assert self.stage.clock.now() < end_s, self.events[-8:]
            await self.stage.clock.sleep(0.1)

    @property
    def phase(self) -> str:
        return self.stage.journal.of_kind(self.mission_id, PhaseChanged)[-1].after

    @property
    def events(self) -> list[Event]:
        return self.stage.journal.events(self.mission_id)

    def count(self, kind: str) -> int:
        return sum(event.kind == kind for event in self.events)

    async def start(self, **flight: object) -> None:
        self.mission_id = await flying(self.stage, "waiting", automatic=False, **flight)

    async def order(self, command: commands.Command) -> object:
        """Why it was refused, None when it was accepted."""
        return (await order(self.stage, self.mission_id, command)).reason

    async def fly_to(self, east: float, north: float) -> None:
        reached = self.count("place_reached")
        assert await self.order(commands.Override(place=FRAME.to_geo(east, north))) is None
        await self.order(commands.Accept())
        await self.until(lambda: self.count("place_reached") > reached)

    async def come_home(self) -> None:
        assert await self.order(commands.Return()) is None
        await self.until(lambda: not self.firmware.flight.armed)


@asynccontextmanager
async def flight(firmware: Firmware, ground: Terrain | None = None) -> AsyncIterator[Flight]:
    stage = Stage(factor=1.0)
    stage.grounds = Shelf(ground)
    made = Flight(stage, firmware)
    async with simulated(firmware, stage.clock, made.see) as vehicle:
        stage.vehicle = vehicle  # type: ignore[assignment]
        stage.room = stage.new_room()
        await stage.room.start_up()
        yield made
        await stage.room.shut_down()
