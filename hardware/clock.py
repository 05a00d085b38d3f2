"""Time as the mission sees it: real time, or a faster one for simulated missions.

Both run on the monotonic clock, so a step of the system's time (NTP, an operator) never moves a running mission.
"""

from __future__ import annotations

import asyncio
import math
import time


class ScaledClock:
    """UTC that starts at `start_utc` (epoch seconds; None: now) and runs `factor` times as fast as real time."""

    def __init__(self, start_utc: float | None = None, factor: float = 1.0) -> None:
        if not (math.isfinite(factor) and factor > 0):
            raise ValueError(
                f"The clock's factor must be a positive number, not {factor}: 1 is real time, 5 five times it."
            )
        if start_utc is not None and not math.isfinite(start_utc):
            raise ValueError(f"The clock's start must be UTC epoch seconds, not {start_utc}.")
        self.factor = factor
        self._start_utc = time.time() if start_utc is None else start_utc
        self._start_monotonic = time.monotonic()

    def now(self) -> float:
        """UTC epoch seconds."""
        return self._start_utc + (time.monotonic() - self._start_monotonic) * self.factor

    async def sleep(self, seconds: float) -> None:
        """Sleep that many of this clock's seconds."""
        await asyncio.sleep(max(0.0, seconds) / self.factor)


class WallClock(ScaledClock):
    """Real time."""

    def __init__(self) -> None:
        super().__init__(None, 1.0)
