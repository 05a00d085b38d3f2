"""The pilot's transmitter sends what a simulator reads, and a switch that was obeyed untold counts as a takeover."""

from __future__ import annotations

import socket
import struct
from collections.abc import Iterator

import pytest

from tests.strikes.pilot import HABITS, Pilot
from tests.strikes.proxy import HEARTBEAT, RC_CHANNELS, Passed, Proxy
from tests.strikes.strike import left_for
from tests.strikes.transmitter import Switch, Transmitter

SWITCH = HABITS["ardupilot"].switch or Switch(0, 0, 0, 0.0)
GUIDED, LOITER = 4, 5


@pytest.fixture
def simulator() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listening:
        listening.bind(("127.0.0.1", 0))
        listening.settimeout(10.0)
        yield listening


@pytest.fixture
def transmitter(simulator: socket.socket) -> Iterator[Transmitter]:
    made = Transmitter(simulator.getsockname(), SWITCH)
    yield made
    made.close()


def pulses(simulator: socket.socket) -> tuple[int, ...]:
    return struct.unpack("<8H", simulator.recv(64))


def test_the_throttle_is_in_the_middle_before_the_switch_takes_the_vehicle(
    simulator: socket.socket, transmitter: Transmitter
) -> None:
    assert pulses(simulator)[4] == SWITCH.given_back_us

    transmitter.take()
    raised, taken = pulses(simulator), pulses(simulator)
    transmitter.give_back()
    given_back = pulses(simulator)
    transmitter.throttle_down()

    assert (raised[2], raised[4]) == (1500, SWITCH.given_back_us)
    assert (taken[2], taken[4]) == (1500, SWITCH.flown_us)
    assert (given_back[2], given_back[4]) == (1500, SWITCH.given_back_us)
    assert pulses(simulator)[2] == 1000


def heard(at_s: float, pulse_us: int) -> Passed:
    return Passed(at_s, "from", RC_CHANNELS, {"chan5_raw": pulse_us})


def shown(at_s: float, mode: int) -> Passed:
    return Passed(at_s, "from", HEARTBEAT, {"custom_mode": mode, "autopilot": 3})


def test_a_switch_that_was_obeyed_and_never_told_counts_and_is_undone(transmitter: Transmitter) -> None:
    record = [heard(9.9, SWITCH.given_back_us), heard(10.1, SWITCH.flown_us), shown(10.2, GUIDED), shown(10.6, GUIDED)]
    proxy = Proxy(record=record)
    pilot = Pilot(proxy, HABITS["ardupilot"], transmitter)

    took_at_s = pilot.took(10.0)

    assert took_at_s == pytest.approx(10.1 + SWITCH.believed_s)
    assert left_for(proxy, pilot, took_at_s or 0.0) == GUIDED


def test_the_mode_tells_before_the_switch_does(transmitter: Transmitter) -> None:
    proxy = Proxy(record=[heard(10.1, SWITCH.flown_us), shown(10.22, LOITER)])
    pilot = Pilot(proxy, HABITS["ardupilot"], transmitter)

    assert pilot.took(10.0) == 10.22
