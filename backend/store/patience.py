"""A time limit for what somebody else does: the time in which this program itself stood still does not count.

While it waits, a thread that has nothing else to do is asked again and again, the way a driver's thread is. One that
is heard from late says that the machine is too busy: then a silence proves nothing about whoever was asked.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncGenerator
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager

LOOK_S = 0.1
LONGEST_LOOK_S = 0.25
"""A look that came later was held up by a busy machine or by our own work; an answer may lie there unread."""
PROMPT_SHARE = 0.5
"""Of the idle thread's answers that a machine with time to spare brings."""

_idle = ThreadPoolExecutor(1, "crossfix-idle")
"""Its thread is made when it is first asked, and serves every wait of the process."""


def _another_idle() -> None:
    """A forked process has none of its parent's threads."""
    global _idle
    _idle = ThreadPoolExecutor(1, "crossfix-idle")


os.register_at_fork(after_in_child=_another_idle)


class StarvedError(TimeoutError):
    """No answer in time, on a machine too busy for it to be expected."""


@asynccontextmanager
async def patience(seconds: float) -> AsyncGenerator[None]:
    """Raises TimeoutError after that many seconds of the wall in which an answer would have been noticed; StarvedError
    when an idle thread of this process was not heard from in time either."""
    loop = asyncio.get_running_loop()
    looked = loop.time()
    waited, heard = 0.0, 0

    def look() -> None:
        nonlocal looked, waited, timer
        now = loop.time()
        waited += min(now - looked, LONGEST_LOOK_S)
        looked = now
        if waited >= seconds:
            limit.reschedule(now)
        else:
            timer = loop.call_later(LOOK_S, look)

    async def listen() -> None:
        nonlocal heard
        while True:
            await asyncio.sleep(LOOK_S)
            await loop.run_in_executor(_idle, _nothing)
            heard += 1

    listening, limit = asyncio.create_task(listen()), asyncio.timeout(None)
    try:
        async with limit:
            timer = loop.call_later(LOOK_S, look)
            try:
                yield
            finally:
                timer.cancel()
    except TimeoutError as error:
        if limit.expired() and heard < int(PROMPT_SHARE * waited / LOOK_S):
            raise StarvedError from error
        raise
    finally:
        listening.cancel()


def _nothing() -> None:
    """That it was run at all is the answer."""
