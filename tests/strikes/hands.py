"""The pilot's hands on the sticks, in a process of their own: a busy test is no transmitter that falls silent.

    python -m tests.strikes.hands HOST PORT SYSTEM

Sends MANUAL_CONTROL twenty times a second to a vehicle's address, and reads from its input a line for each move of the
sticks: pitch, roll, throttle, yaw. Ends with its input.
"""

from __future__ import annotations

import socket
import sys
import threading
import time

from pymavlink.dialects.v20 import development as mavlink

PILOT_SYSTEM, PILOT_COMPONENT = 254, 190
NEUTRAL = (0, 0, 500, 0)
"""Pitch, roll, throttle, yaw of MANUAL_CONTROL: hands off."""
PUSHED = (700, 0, 500, 0)
EVERY_S = 0.05


class Hands:
    """sticks: as they stand now."""

    def __init__(self, address: tuple[str, int], system: int) -> None:
        self.sticks: tuple[int, int, int, int] = NEUTRAL
        self._address = address
        self._system = system
        self._encoder = mavlink.MAVLink(None, PILOT_SYSTEM, PILOT_COMPONENT)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def send(self) -> None:
        message = self._encoder.manual_control_encode(self._system, *self.sticks, 0)
        self._socket.sendto(bytes(message.pack(self._encoder)), self._address)


def main() -> None:
    host, port, system = sys.argv[1:]
    hands = Hands((host, int(port)), int(system))

    def hold_on() -> None:
        while True:
            hands.send()
            time.sleep(EVERY_S)

    threading.Thread(target=hold_on, daemon=True).start()
    for line in sys.stdin:
        pitch, roll, throttle, yaw = map(int, line.split())
        hands.sticks = pitch, roll, throttle, yaw


if __name__ == "__main__":
    main()
