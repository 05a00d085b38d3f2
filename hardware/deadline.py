"""Waiting on the mission's clock, with a floor in wall time: the link and CPU of a sped-up mission are no faster."""

from __future__ import annotations

import time

from hardware.ports import Clock


class Deadline:
    """Passed once `seconds` of the clock *and* `wall_floor_s` of wall time have gone by."""

    def __init__(self, clock: Clock, seconds: float, wall_floor_s: float = 0.0) -> None:
        self._clock = clock
        self._end = clock.now() + seconds
        self._wall_end = time.monotonic() + wall_floor_s

    @property
    def passed(self) -> bool:
        """Asked afresh each time; once true it stays so."""
        return self._clock.now() >= self._end and time.monotonic() >= self._wall_end
