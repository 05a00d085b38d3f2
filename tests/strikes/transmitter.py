"""The pilot's transmitter, as ArduPilot's simulator takes it: pulses of the channels by UDP, repeated by itself."""

from __future__ import annotations

import socket
import struct
from dataclasses import dataclass

THROTTLE = 3
LOW_US, MIDDLE_US = 1000, 1500
AT_SWITCH_ON_US = (MIDDLE_US, MIDDLE_US, LOW_US, MIDDLE_US, 1800, 1000, 1000, 1800)
"""What the simulator has by itself before anybody sends: throttle down."""


@dataclass(frozen=True, slots=True)
class Switch:
    """A mode switch. channel: counted from 1. believed_s: how long the autopilot waits before it obeys a new position.

    flown_us, given_back_us: the positions of the pilot's mode and of a mode that waits for commands.
    """

    channel: int
    flown_us: int
    given_back_us: int
    believed_s: float


class Transmitter:
    """switch: as the autopilot's parameters have it."""

    def __init__(self, address: tuple[str, int], switch: Switch) -> None:
        self.switch = switch
        self._address = address
        self._pulses_us: list[int] = list(AT_SWITCH_ON_US)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.give_back()

    def take(self) -> None:
        """Throttle in the middle, as a pilot does before they take a vehicle that flies; then the switch."""
        self._set(THROTTLE, MIDDLE_US)
        self._set(self.switch.channel, self.switch.flown_us)

    def give_back(self) -> None:
        self._set(self.switch.channel, self.switch.given_back_us)

    def throttle_down(self) -> None:
        """On the ground: ArduPilot does not arm with a throttle in the middle."""
        self._set(THROTTLE, LOW_US)

    def close(self) -> None:
        self._socket.close()

    def _set(self, channel: int, pulse_us: int) -> None:
        self._pulses_us[channel - 1] = pulse_us
        self._socket.sendto(struct.pack("<8H", *self._pulses_us), self._address)
