"""What the vehicle link tells whoever listens: that something came in, and what it noticed."""

from __future__ import annotations

import asyncio
import contextlib

from hardware.readings import Announcement


class Wakeup:
    """Wakes whoever waits for the vehicle's next message."""

    def __init__(self) -> None:
        self._event = asyncio.Event()

    def wake(self) -> None:
        """From the event loop only: whoever waits runs at its next turn."""
        self._event.set()

    async def wait(self, wall_s: float = 0.1) -> None:
        """Until something comes in, or `wall_s` of wall time have gone by. What came before is no news: look first."""
        self._event.clear()
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(wall_s):
                await self._event.wait()


class Announcer:
    """Hands each announcement to every listener; a listener that sleeps loses the oldest, never delays anybody."""

    def __init__(self, depth: int = 200) -> None:
        self._depth = depth
        self._queues: set[asyncio.Queue[Announcement | None]] = set()

    def say(self, announcement: Announcement) -> None:
        """To everyone who listens now; never waits."""
        for queue in self._queues:
            if queue.full():
                queue.get_nowait()
            queue.put_nowait(announcement)

    def listen(self) -> asyncio.Queue[Announcement | None]:
        """What is announced from now on; None is the end. `forget` it when done."""
        queue: asyncio.Queue[Announcement | None] = asyncio.Queue(self._depth)
        self._queues.add(queue)
        return queue

    def forget(self, queue: asyncio.Queue[Announcement | None]) -> None:
        """Harmless for a queue that is already forgotten."""
        self._queues.discard(queue)

    def end(self) -> None:
        """Tells every listener that nothing more comes; a full queue loses its oldest for that."""
        for queue in self._queues:
            if queue.full():
                queue.get_nowait()
            queue.put_nowait(None)
