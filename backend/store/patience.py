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
from pathlib import Path

LOOK_S = 0.1
LONGEST_LOOK_S = 0.25
"""A look that came later was held up by a busy machine or by our own work; an answer may lie there unread."""
PROMPT_SHARE = 0.5
"""Of the idle thread's answers that a machine with time to spare brings."""

LONG_SHARE = 0.5
"""Of a wait: less of it spent on something does not explain it."""

PRESSURE = Path("/proc/pressure")
"""What Linux tells of tasks that wait for a processor or for a disk."""

_idle = ThreadPoolExecutor(1, "crossfix-idle")
"""Its thread is made when it is first asked, and serves every wait of the process."""


def _another_idle() -> None:
    """A forked process has none of its parent's threads."""
    global _idle
    _idle = ThreadPoolExecutor(1, "crossfix-idle")


os.register_at_fork(after_in_child=_another_idle)


class StarvedError(TimeoutError):
    """No answer in time, on a machine too busy for it to be expected."""


class CrowdedError(TimeoutError):
    """No answer in time, while something waited for a processor most of the time and nothing for a disk. This
    program's own threads were heard, so that it is no excuse for who answers on another machine."""


@asynccontextmanager
async def patience(seconds: float) -> AsyncGenerator[None]:
    """Raises TimeoutError after that many seconds of wall time in which an answer would have been noticed; StarvedError
    when an idle thread of this process was not heard from in time either, CrowdedError when the kernel says that the
    machine was short of processors and not of its disk."""
    loop = asyncio.get_running_loop()
    began = looked = loop.time()
    stalled = _stalled_s()
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
        if limit.expired() and _crowded(stalled, _stalled_s(), LONG_SHARE * (loop.time() - began)):
            raise CrowdedError from error
        raise
    finally:
        listening.cancel()


def _nothing() -> None:
    """That it was run at all is the answer."""


def _stalled_s() -> tuple[float, float] | None:
    """For how long, since the machine's start, some task of it waited for a processor, and for a disk. None where the
    system does not say."""
    try:
        told = [(PRESSURE / of).read_text().splitlines()[0] for of in ("cpu", "io")]
        processor, disk = (1e-6 * float(line.rpartition("total=")[2]) for line in told)
    except (OSError, ValueError, IndexError):
        return None
    return processor, disk


def _crowded(before: tuple[float, float] | None, after: tuple[float, float] | None, long_s: float) -> bool:
    """before, after: `_stalled_s`."""
    if before is None or after is None:
        return False
    processor, disk = (then - now for now, then in zip(before, after, strict=True))
    return disk < long_s <= processor
