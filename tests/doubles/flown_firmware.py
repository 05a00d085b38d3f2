"""A simulated autopilot without its link, stepped by hand."""

from __future__ import annotations

import pytest

from hardware.sim.autopilot.ardupilot import ArduCopter
from hardware.sim.autopilot.firmware import ACCEPTED, Command, Conditions, Firmware
from hardware.sim.autopilot.geodesy import HomeFrame
from hardware.sim.autopilot.px4 import Px4

ARM, TAKE_OFF, SET_MODE = 400, 22, 176
HOME = HomeFrame(47.4, 8.5, 488.0)


def run(firmware: Firmware, seconds: float) -> Firmware:
    end = firmware.time + seconds
    while firmware.time < end:
        firmware.step(0.02)
    return firmware


def make(flavour: type[Px4] | type[ArduCopter], **conditions: object) -> Firmware:
    return flavour(Conditions(home=HOME, **conditions))  # pyright: ignore[reportArgumentType]


def flying(flavour: type[Px4] | type[ArduCopter], up: float = 20.0, **conditions: object) -> Firmware:
    firmware = run(make(flavour, **conditions), 10.0)
    if isinstance(firmware, ArduCopter):
        assert firmware.command(Command(SET_MODE, 1.0, 4.0)) == ACCEPTED
    assert firmware.command(Command(ARM, 1.0)) == ACCEPTED
    z = up if isinstance(firmware, ArduCopter) else HOME.amsl_m + up
    assert firmware.command(Command(TAKE_OFF, z=z)) == ACCEPTED
    run(firmware, 25.0)
    assert firmware.navigation.up == pytest.approx(up, abs=1.0)
    return firmware
