"""The loop of the simulator's process: wall time to simulated steps, UDP to a ground station, UDP for orders."""

from __future__ import annotations

import contextlib
import os
import select
import socket
import time
from dataclasses import dataclass

from hardware.sim.autopilot.firmware import Firmware
from hardware.sim.autopilot.orders import Orders
from hardware.sim.autopilot.radio import Radio
from hardware.sim.autopilot.station import Station

STEP = 0.02
"""Simulated seconds a step."""
MOST_BEHIND_WALL = 5.0
"""When the process was suspended for longer than this, the time it missed is not made up for."""
LOOK_UP_AGAIN = 5.0
"""Wall seconds of silence after which the ground station's name is looked up again."""


@dataclass(frozen=True, slots=True)
class Endpoint:
    """Of the ground station. host: an IPv4 address or a name."""

    host: str
    port: int


@dataclass(frozen=True, slots=True)
class Schedule:
    """How time passes, and when the process ends. Wall seconds.

    station_timeout: a ground station is not taken for lost earlier, whatever the parameter says: its heartbeats come by
    the wall clock and its restart takes wall time, however fast the simulation runs.
    clock_rate: the vehicle's seconds a wall-clock second, over `speedup`: a cheap crystal, or an overloaded simulator.
    parent: ends when this process (our parent) is gone. linger: ends when nobody was heard for this long, in seconds.
    """

    speedup: float = 1.0
    clock_rate: float = 1.0
    station_timeout: float = 8.0
    parent: int | None = None
    linger: float | None = None


class Process:
    """Sockets bound, not yet running. `connect`: where the ground station listens; `control_port`: for orders;
    `token`: see Orders."""

    def __init__(
        self, firmware: Firmware, connect: Endpoint, control_port: int, schedule: Schedule, token: str = ""
    ) -> None:
        firmware.gcs_timeout_floor = schedule.station_timeout * schedule.speedup
        self._firmware = firmware
        self._station = Station(firmware)
        self._orders = Orders(firmware, token)
        self._connect = connect
        self._peer = (socket.gethostbyname(connect.host), connect.port)
        self._speedup = schedule.speedup * schedule.clock_rate
        self._down, self._up = Radio(), Radio()
        self._schedule = schedule
        self._heard_at = self._looked_up_at = time.monotonic()
        self._link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._link.bind(("127.0.0.1" if connect.host.startswith("127.") else "0.0.0.0", 0))
        self._control = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._control.bind(("127.0.0.1", control_port))
        for each in (self._link, self._control):
            each.setblocking(False)
        self._tick = min(0.02, max(0.002, STEP / schedule.speedup))

    @property
    def control_port(self) -> int:
        """The UDP port that orders go to, also when any free one was asked for."""
        return self._control.getsockname()[1]

    def run(self) -> None:
        """Until ordered to stop or abandoned."""
        started, next_look = time.monotonic(), 0.0
        while not self._orders.stop_requested:
            now = time.monotonic()
            behind = (now - started) - self._firmware.time / self._speedup
            if self._firmware.rebooted:
                self._firmware.rebooted = False
                self._station.default_streams()
                started += behind
            elif behind > MOST_BEHIND_WALL:
                started += behind
            self._advance((now - started) * self._speedup)
            self._deliver()
            if now >= next_look:
                next_look = now + 0.25
                if self._abandoned(now):
                    return
                if now - max(self._heard_at, self._looked_up_at) > LOOK_UP_AGAIN:
                    self._look_up_station(now)
            tick = min(self._tick, 0.002) if self._firmware.faults.link_delay else self._tick
            readable, _, _ = select.select([self._link, self._control], [], [], tick)
            for each in readable:
                self._read(each)

    def _look_up_station(self, now: float) -> None:
        """A ground station that fell silent may come back at another address, as a container does."""
        self._looked_up_at = now
        with contextlib.suppress(socket.gaierror):
            self._peer = (socket.gethostbyname(self._connect.host), self._connect.port)

    def _abandoned(self, now: float) -> bool:
        parent, linger = self._schedule.parent, self._schedule.linger
        orphaned = parent is not None and os.getppid() != parent
        return orphaned or (linger is not None and now - self._heard_at > linger)

    def _advance(self, until: float) -> None:
        firmware = self._firmware
        while firmware.time + STEP <= until:
            firmware.step(STEP)
            for packet in self._station.due():
                self._send(packet)

    @property
    def _link_lost(self) -> bool:
        return self._firmware.time < self._firmware.faults.link_lost_until

    def _arrival(self) -> float:
        """When a packet sent now comes out of the radio, by the wall clock."""
        return time.monotonic() + self._firmware.faults.link_delay / self._speedup

    def _send(self, packet: bytes) -> None:
        self._down.put(packet, self._arrival())

    def _deliver(self) -> None:
        """A link that is lost loses what is under way, too."""
        for packet in self._up.arrived(time.monotonic()):
            if not (self._link_lost or self._firmware.time < self._firmware.faults.uplink_lost_until):
                for answer in self._station.receive(packet):
                    self._send(answer)
        for packet in self._down.arrived(time.monotonic()):
            if not self._link_lost:
                with contextlib.suppress(ConnectionError, BlockingIOError):
                    self._link.sendto(packet, self._peer)

    def _read(self, source: socket.socket) -> None:
        while True:
            try:
                data, sender = source.recvfrom(4096)
            except BlockingIOError:
                return
            except ConnectionError:
                continue
            self._heard_at = time.monotonic()
            if source is self._control:
                with contextlib.suppress(OSError):
                    source.sendto(self._orders.receive(data), sender)
            else:
                self._up.put(data, self._arrival())

    def close(self) -> None:
        """Frees both ports."""
        self._link.close()
        self._control.close()
