"""Time for tests that must not wait: sleeping advances it at once."""

from __future__ import annotations

import asyncio


class SteppedClock:
    """The Clock port. `time_s`: UTC epoch seconds, may be set."""

    def __init__(self, time_s: float = 1_780_000_000.0) -> None:
        self.time_s = time_s

    def now(self) -> float:
        return self.time_s

    async def sleep(self, seconds: float) -> None:
        self.time_s += seconds
        await asyncio.sleep(0)
