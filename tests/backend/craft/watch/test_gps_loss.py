"""From the loss of GPS to the alert and the hold, in the vehicle's own time: no wall clock is in it."""

from __future__ import annotations

import pytest
from craft_walk import craft_in, sent
from pymavlink.dialects.v20 import development as mavlink

from backend.craft import effects, inputs
from backend.craft.watch.links import LinkWatch
from backend.craft.watch.watch import TICK_S
from backend.reasons.flight import PlaceUnknown
from hardware.authority import NOBODY
from hardware.autopilot.monitor import STREAMS
from hardware.autopilot.snapshot import NAMES, Snapshot
from hardware.sim.autopilot.ardupilot import ArduCopter
from hardware.sim.autopilot.firmware import Conditions, Firmware
from hardware.sim.autopilot.geodesy import HomeFrame
from hardware.sim.autopilot.px4 import Px4
from hardware.sim.autopilot.station import Station

STEP_S, TOLD_WITHIN_S, DELAY_S = 0.02, 1.0, 0.15


class Told:
    """The autopilot's messages as they are asked for and folded, `DELAY_S` late, and the watch that looks at them."""

    def __init__(self, flavour: type[Firmware], looks_after_s: float) -> None:
        self.firmware = flavour(Conditions(home=HomeFrame(47.4, 8.5, 488.0)))  # pyright: ignore[reportCallIssue]
        self.station, self.ear = Station(self.firmware), mavlink.MAVLink(None, 255, 190)
        self.snapshot, self.links = Snapshot(), LinkWatch()
        self.late: list[tuple[float, bytes]] = []
        self.looks_at_s = looks_after_s
        for message, hz in STREAMS:
            ask = mavlink.MAVLink_command_long_message(1, 1, 511, 0, message, 1e6 / hz, 0, 0, 0, 0, 0)
            self.station.receive(bytes(ask.pack(self.ear)))

    def step(self) -> list[inputs.CraftInput]:
        self.firmware.step(STEP_S)
        now = self.firmware.time
        self.late += [(now + DELAY_S, packet) for packet in self.station.due()]
        arrived = [packet for at_s, packet in self.late if at_s <= now]
        self.late = [(at_s, packet) for at_s, packet in self.late if at_s > now]
        for message in (message for packet in arrived for message in self.ear.parse_buffer(packet) or []):
            if message.get_type() in NAMES:
                self.snapshot.fold(message.get_type(), message.to_dict(), now)
        if now < self.looks_at_s:
            return []
        self.looks_at_s = now + TICK_S
        return self.links.look(self.snapshot.telemetry(now, True, None, NOBODY, "unknown"), now, None, None)


@pytest.mark.parametrize("flavour", [Px4, ArduCopter])
def test_the_operator_is_told_within_a_second_and_the_craft_holds_whenever_it_happens(flavour: type[Firmware]) -> None:
    took: list[float] = []
    for number in range(10):
        told = Told(flavour, looks_after_s=0.06 * number)
        assert [found for _ in range(500 + number) for found in told.step()] == []
        lost_at_s = told.firmware.time
        told.firmware.navigation.lose_fix(30.0)
        found: list[inputs.CraftInput] = []
        while not found and told.firmware.time < lost_at_s + 10.0:
            found = told.step()
        took.append(told.firmware.time - lost_at_s)
        assert found == [inputs.LinkDown("gps", PlaceUnknown())]
        walk = craft_in("flying")
        assert sent(walk.give(found[0])) == [effects.HoldVehicle()]
        assert (walk.last_alert.topic, walk.last_alert.level) == ("gps", "warning")
        told_at_s = told.firmware.time
        assert [found for _ in range(20) for found in told.step()] == []
        since = told.snapshot.headings(told_at_s + STEP_S)
        assert since
        assert all(sample.position is None for sample in since)
    assert max(took) <= TOLD_WITHIN_S, took
    assert min(took) > DELAY_S
