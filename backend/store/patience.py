"""A time limit for what somebody else does: the time in which this program itself stood still does not count."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

LOOK_S = 0.1
LONGEST_LOOK_S = 0.25
"""A look that came later was held up by a busy machine or by our own work; an answer may lie there unread."""


@asynccontextmanager
async def patience(seconds: float) -> AsyncGenerator[None]:
    """Raises TimeoutError after that many seconds of the wall in which an answer would have been noticed."""
    loop = asyncio.get_running_loop()
    looked, waited = loop.time(), 0.0

    def look() -> None:
        nonlocal looked, waited, timer
        now = loop.time()
        waited += min(now - looked, LONGEST_LOOK_S)
        looked = now
        if waited >= seconds:
            limit.reschedule(now)
        else:
            timer = loop.call_later(LOOK_S, look)

    async with asyncio.timeout(None) as limit:
        timer = loop.call_later(LOOK_S, look)
        try:
            yield
        finally:
            timer.cancel()
