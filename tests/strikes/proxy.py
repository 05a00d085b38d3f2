"""Between the program under test and a real autopilot: delays each way, losses, a record, and a way in for a pilot.

The record is kept at the vehicle's end: when a message left the autopilot and when a command reached it.
"""

from __future__ import annotations

import random
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from typing import Any, Literal

from hardware.sim.autopilot.launch import free_port
from tests.strikes.frames import Frame
from tests.strikes.lane import Lane
from tests.strikes.wire import Address, Send, datagrams, vehicle_end

HEARTBEAT, SYS_STATUS, COMMAND_INT, COMMAND_LONG, COMMAND_ACK, STATUS_TEXT, CURRENT_MODE = 0, 1, 75, 76, 77, 253, 436
ATTITUDE, GLOBAL_POSITION, RC_CHANNELS, BATTERY_STATUS = 30, 33, 65, 147
KEPT = frozenset(
    {HEARTBEAT, SYS_STATUS, COMMAND_INT, COMMAND_LONG, COMMAND_ACK, STATUS_TEXT, CURRENT_MODE, RC_CHANNELS}
)
"""Numbers of the messages in the record, unless a proxy is given others."""


@dataclass(frozen=True, slots=True)
class Passed:
    """at_s: of time.monotonic, at the vehicle's end. way: to the vehicle, from it, or put in by the pilot."""

    at_s: float
    way: Literal["to", "from", "pilot"]
    number: int
    fields: dict[str, Any]


@dataclass
class Proxy:
    """delay_s: each way. loss: share of frames, each way. url: where the program under test finds the vehicle.
    system: the vehicle's MAVLink id, since it was heard. vehicle_address: where it hears datagrams, since then.

    on_sent(number, fields): a kept message left the program under test and reaches the vehicle `delay_s` later.
    """

    delay_s: float = 0.0
    loss: float = 0.0
    url: str = ""
    system: int = 1
    kept: frozenset[int] = KEPT
    record: list[Passed] = field(default_factory=list[Passed])
    on_sent: Callable[[int, dict[str, Any]], None] | None = None
    chance: random.Random = field(default_factory=lambda: random.Random(1))
    to_vehicle: Send = lambda raw: None
    to_program: Send = lambda raw: None
    vehicle_address: Callable[[], Address | None] = lambda: None
    _to_lane: Lane = field(default_factory=Lane)
    _from_lane: Lane = field(default_factory=Lane)

    def since(self, at_s: float) -> list[Passed]:
        """What passed at or after `at_s`."""
        first = len(self.record)
        while first and self.record[first - 1].at_s >= at_s:
            first -= 1
        return self.record[first:]

    def held_up_s(self) -> float:
        """By how much something was delivered later than due, at most, since this was asked last."""
        lanes = (self._to_lane, self._from_lane)
        found = max(lane.late_s for lane in lanes)
        for lane in lanes:
            lane.late_s = 0.0
        return found

    def from_program(self, frame: Frame) -> None:
        fields = frame.fields() if frame.number in self.kept else None
        if self.chance.random() < self.loss:
            return
        if fields is not None and self.on_sent is not None:
            self.on_sent(frame.number, fields)
        self._to_lane.put(lambda: self._reach_vehicle(frame, fields), self.delay_s)

    def _reach_vehicle(self, frame: Frame, fields: dict[str, Any] | None) -> None:
        self.to_vehicle(frame.raw)
        if fields is not None:
            self.record.append(Passed(time.monotonic(), "to", frame.number, fields))

    def from_vehicle(self, frame: Frame) -> None:
        self.system = frame.system
        if frame.number in self.kept:
            self.record.append(Passed(time.monotonic(), "from", frame.number, frame.fields()))
        if self.chance.random() >= self.loss:
            self._from_lane.put(lambda: self.to_program(frame.raw), self.delay_s)

    def put_in(self, raw: bytes, number: int, fields: dict[str, Any]) -> float:
        """What a pilot's own radio brings to the autopilot: no delay, no loss. Returns when."""
        self.to_vehicle(raw)
        now = time.monotonic()
        if number in self.kept:
            self.record.append(Passed(now, "pilot", number, fields))
        return now


@asynccontextmanager
async def proxied(vehicle_url: str) -> AsyncIterator[Proxy]:
    """A proxy to the vehicle; the program under test connects to its `url`."""
    proxy = Proxy()
    port = free_port()
    proxy.url = f"udpin://127.0.0.1:{port}"
    program = ("127.0.0.1", port)
    async with (
        vehicle_end(vehicle_url, proxy.from_vehicle) as vehicle_side,
        datagrams(proxy.from_program, peer=program) as program_side,
    ):
        proxy.to_vehicle, proxy.to_program = vehicle_side.send, program_side.send
        proxy.vehicle_address = vehicle_side.address
        yield proxy
