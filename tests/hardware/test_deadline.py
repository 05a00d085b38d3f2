from __future__ import annotations

import asyncio

from hardware.clock import ScaledClock
from hardware.deadline import Deadline


async def test_a_deadline_waits_for_the_slower_of_clock_and_wall() -> None:
    fast = ScaledClock(None, 1000.0)
    clock_only, floored = Deadline(fast, 5.0), Deadline(fast, 5.0, wall_floor_s=30.0)
    slow = Deadline(ScaledClock(None, 0.001), 5.0)

    await asyncio.sleep(0.03)

    assert clock_only.passed
    assert not floored.passed
    assert not slow.passed
