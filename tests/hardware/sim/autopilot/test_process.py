"""The simulated autopilot's process and its ground station."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator

import pytest

from hardware.sim.autopilot import process
from hardware.sim.autopilot.firmware import Conditions
from hardware.sim.autopilot.geodesy import HomeFrame
from hardware.sim.autopilot.process import Endpoint, Process, Schedule
from hardware.sim.autopilot.px4 import Px4


@pytest.fixture
def listening() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as station:
        station.bind(("127.0.0.2", 0))
        station.settimeout(10.0)
        yield station


def test_a_ground_station_that_moved_to_another_address_is_found_again(
    listening: socket.socket, monkeypatch: pytest.MonkeyPatch
):
    addresses = iter(["127.0.0.1"])
    monkeypatch.setattr(process, "LOOK_UP_AGAIN", 0.1)
    monkeypatch.setattr(socket, "gethostbyname", lambda name: next(addresses, "127.0.0.2"))
    there = Endpoint("ground-station", listening.getsockname()[1])
    firmware = Px4(Conditions(home=HomeFrame(47.4, 8.5, 488.0)))
    vehicle = Process(firmware, there, control_port=0, schedule=Schedule(linger=2.0))
    running = threading.Thread(target=vehicle.run)
    running.start()
    try:
        assert listening.recv(4096)
    finally:
        running.join()
        vehicle.close()
