"""The vehicle adapter on a simulated autopilot without sockets: both step in the time of a SteppedLoop."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega
from pymavlink.dialects.v20 import development as mavlink

from hardware.autopilot.fence_items import FenceItem
from hardware.autopilot.link import Fields
from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.clock import ScaledClock
from hardware.sim.autopilot.fence import Item
from hardware.sim.autopilot.firmware import Firmware
from hardware.sim.autopilot.station import Station

STEP_S = 0.02
_MESSAGES: dict[str, Any] = {one.msgname: one for one in mavlink.mavlink_map.values()}


class SimulatedLink:
    """What MavlinkLink is to the monitor. delay_s: each way; clock_rate: the autopilot's seconds in one of the loop's.
    seen: asked after each step of the autopilot, with the loop's time at it."""

    url = "simulated"
    system_id = 1

    def __init__(
        self,
        firmware: Firmware,
        on_message: Callable[[str, Fields], None],
        names: Sequence[str],
        delay_s: float,
        clock_rate: float,
        seen: Callable[[Firmware], None],
    ) -> None:
        self._firmware, self._on_message, self._names = firmware, on_message, frozenset(names)
        self._delay_s, self._rate, self._seen = delay_s, clock_rate, seen
        self._station = Station(firmware)
        self._encoder, self._decoder = mavlink.MAVLink(None, 255, 190), ardupilotmega.MAVLink(None)
        self._latest_s = [0.0, 0.0]
        self._tasks: list[asyncio.Task[None]] = []

    async def open(self, timeout_s: float) -> None:
        if self._tasks:  # a room connects what `simulated` has connected, and there is one autopilot
            return
        self._tasks = [asyncio.create_task(self._fly()), asyncio.create_task(self._beat())]

    async def _fly(self) -> None:
        while True:
            self._firmware.step(STEP_S)
            self._seen(self._firmware)
            self._later(1, self._heard, list(self._station.due()))
            await asyncio.sleep(STEP_S / self._rate)

    async def _beat(self) -> None:
        while True:
            beat = mavlink.MAVLink_heartbeat_message(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3)
            self._later(0, self._arrived, bytes(beat.pack(self._encoder)))
            await asyncio.sleep(1.0)

    def _later(self, way: int, then: Callable[[Any], None], what: object) -> None:
        """In the order in which it was sent: timers of one moment have none."""
        loop = asyncio.get_running_loop()
        self._latest_s[way] = max(loop.time() + self._delay_s, math.nextafter(self._latest_s[way], math.inf))
        loop.call_at(self._latest_s[way], then, what)

    def _arrived(self, packet: bytes) -> None:
        self._later(1, self._heard, self._station.receive(packet))

    def _heard(self, packets: Sequence[bytes]) -> None:
        for packet in packets if self._tasks else ():
            for message in self._decoder.parse_buffer(packet) or []:
                if message.get_type() in self._names:
                    self._on_message(message.get_type(), _as_json(message.to_dict()))

    async def send(self, name: str, fields: Fields, allowed: Callable[[], bool]) -> bool:
        if not allowed():
            return False
        kind = _MESSAGES[name]
        addressed = {"target_system": 1, "target_component": 1} | fields
        given = {key: math.nan if value is None else value for key, value in addressed.items()}
        message = kind(**{key: value for key, value in given.items() if key in kind.fieldnames})
        self._later(0, self._arrived, bytes(message.pack(self._encoder)))
        return True

    async def parameter(self, name: str) -> float | None:
        await asyncio.sleep(2.0 * self._delay_s)
        known = name in self._firmware.parameters
        return self._firmware.parameters[name] if known else None

    def has_answered(self, name: str) -> bool:
        return name in self._firmware.parameters

    async def set_parameter(self, name: str, value: float) -> bool:
        await asyncio.sleep(2.0 * self._delay_s)
        self._firmware.parameters.set(name, value)
        return True

    async def fence(self) -> list[FenceItem]:
        return [FenceItem(one.number, one.first, one.lat_e7, one.lon_e7) for one in self._firmware.fence.items]

    async def set_fence(self, items: Sequence[FenceItem]) -> None:
        self._firmware.fence.items = tuple(Item(one.number, one.first, one.lat_e7, one.lon_e7) for one in items)

    async def close(self) -> None:
        tasks, self._tasks = self._tasks, []
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


def _as_json(fields: Fields) -> Fields:
    """MAVSDK has no NaN."""
    return {key: None if isinstance(value, float) and math.isnan(value) else value for key, value in fields.items()}


def _nobody(firmware: Firmware) -> None:
    pass


@asynccontextmanager
async def simulated(
    firmware: Firmware,
    clock: ScaledClock,
    seen: Callable[[Firmware], None] = _nobody,
    delay_s: float = 0.0,
    clock_rate: float = 1.0,
) -> AsyncIterator[MavsdkVehicle]:
    """The adapter, connected, and ready to arm."""

    def link(url: str, names: Sequence[str], on_message: Callable[[str, Fields], None], _: object) -> SimulatedLink:
        return SimulatedLink(firmware, on_message, names, delay_s, clock_rate, seen)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hardware.autopilot.monitor.MavlinkLink", link)
        vehicle = MavsdkVehicle("udpin://127.0.0.1:1", clock)
    await vehicle.connect()
    try:
        while not firmware.prearm_ok:
            await clock.sleep(0.5)
        await clock.sleep(2.0)
        yield vehicle
    finally:
        await vehicle.close()
