"""The pilot's mode switch itself, as the autopilot hears it from their transmitter. Pure.

A switch that meets one of our orders within one turn of the autopilot's own loop is undone before its mode is reported:
by the mode alone, nobody ever took over. The channel of the switch has moved all the same.
"""

from __future__ import annotations

import math
from typing import Any

Fields = dict[str, Any]

MOVED_US = 100
"""Positions of a switch lie further apart, the noise of a receiver far closer together (microseconds of pulse)."""
LEAST_US, MOST_US = 800, 2200
"""What lies outside is no position: no transmitter is heard."""
SETTLED_S = 0.3
"""An autopilot waits for 0.2 s before it believes a switch; its own word of the mode comes first where there is one."""
GIVEN_BACK_S = 1.0
"""For this long after an operator took the vehicle the pilot's return to the autopilot's mode may still be told."""


class ModeSwitch:
    """channel: counted from 1, None while it is not known which one it is."""

    def __init__(self) -> None:
        self.channel: int | None = None
        self._position_us: int | None = None
        self._moved_at_s: float | None = None
        self._taken_back_at_s = -math.inf

    def see(self, fields: Fields, at_s: float) -> None:
        """Fields of RC_CHANNELS, heard at_s."""
        if self.channel is None:
            return
        pulse_us = int(fields.get(f"chan{self.channel}_raw") or 0)
        if not LEAST_US <= pulse_us <= MOST_US:
            return
        if self._position_us is None or abs(pulse_us - self._position_us) > MOVED_US:
            returning = at_s - self._taken_back_at_s < GIVEN_BACK_S
            self._moved_at_s = None if self._position_us is None or returning else at_s
            self._position_us = pulse_us

    def taken_back(self, at_s: float) -> None:
        """An operator took the vehicle: what moved before was the pilot's way to give it back."""
        self._moved_at_s, self._taken_back_at_s = None, at_s

    def take_moved(self, now_s: float) -> bool:
        """True once for each movement, when it has settled."""
        moved = self._moved_at_s is not None and now_s - self._moved_at_s >= SETTLED_S
        if moved:
            self._moved_at_s = None
        return moved
