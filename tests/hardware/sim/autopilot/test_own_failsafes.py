"""What each flavour says as its own failsafe acts, as it was measured on the real one."""

from __future__ import annotations

import math

from flown_firmware import flying, run
from pymavlink.dialects.v20 import development as mavlink

from hardware.sim.autopilot.ardupilot import ArduCopter
from hardware.sim.autopilot.firmware import Firmware
from hardware.sim.autopilot.px4 import Px4


def texts(firmware: Firmware) -> list[str]:
    return [message.text for message in firmware.outbox if isinstance(message, mavlink.MAVLink_statustext_message)]


def test_px4_hovers_before_it_acts_says_both_and_gives_way_to_whoever_selects_a_mode() -> None:
    firmware = flying(Px4)
    firmware.transmitter_lost_until = math.inf
    run(firmware, 2.0)
    assert (firmware.mode, firmware.critical) == ("HOLD", True)
    run(firmware, 4.0)
    assert (firmware.mode, firmware.critical) == ("RETURN", True)
    said = [text.strip() for text in texts(firmware)]
    assert said[-2:] == ["Failsafe activated: entering Hold for 5 seconds", "Failsafe activated"]
    firmware.switch_mode("RETURN")
    assert (firmware.mode, firmware.critical) == ("RETURN", False)
    again = flying(Px4)
    again.transmitter_lost_until = math.inf
    run(again, 2.0)
    again.switch_mode("HOLD")
    run(again, 10.0)
    assert (again.mode, again.critical) == ("HOLD", False)


def test_arducopter_acts_at_once_and_stays_critical() -> None:
    firmware = flying(ArduCopter)
    firmware.transmitter_lost_until = math.inf
    run(firmware, 2.0)
    assert (firmware.mode, texts(firmware)[-1]) == ("RTL", "Radio Failsafe")
    firmware.switch_mode("BRAKE")
    run(firmware, 2.0)
    assert (firmware.mode, firmware.critical) == ("BRAKE", True)
