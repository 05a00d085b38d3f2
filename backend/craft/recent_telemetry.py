"""Telemetry that was held up is waited for before it is held against the vehicle."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Callable

from backend.craft.safety import Situation

RECENT_S = 1.0
PATIENCE_WALL_S = 3.0
"""As long as the link may be silent before it counts as lost."""


async def recent(situation: Callable[[], Situation]) -> Situation:
    """The situation as soon as its position is at most RECENT_S old; what there is after PATIENCE_WALL_S.

    At once when there is nothing to wait for: no position was ever heard, or the link is known to be lost.
    """
    until = time.monotonic() + PATIENCE_WALL_S
    while True:
        now = situation()
        held_up = now.telemetry.connected and RECENT_S < now.position_age_s < math.inf
        if not held_up or time.monotonic() > until:
            return now
        await asyncio.sleep(0.02)
