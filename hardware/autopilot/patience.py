"""Waiting on the mission's clock, with a floor in wall time: the link and CPU of a sped-up mission are no faster."""

from __future__ import annotations

import asyncio
import contextlib
import time

from hardware.ports import Clock


class Deadline:
    """Passed once `seconds` of the clock *and* `wall_floor_s` of the wall have gone by."""

    def __init__(self, clock: Clock, seconds: float, wall_floor_s: float = 0.0) -> None:
        self._clock = clock
        self._end = clock.now() + seconds
        self._wall_end = time.monotonic() + wall_floor_s

    @property
    def passed(self) -> bool:
        return self._clock.now() >= self._end and time.monotonic() >= self._wall_end


class Silence:
    """How long nothing was heard, in seconds of the wall in which it would have been noticed.

    A radio link and its messages live in the wall's time, however fast a simulation runs; and a look that came late
    because this program stood still counts for `longest_look_s` only: what waits to be read was heard.
    """

    def __init__(self, longest_look_s: float = 0.5) -> None:
        self._longest_look_s = longest_look_s
        self.seconds = 0.0

    def heard(self) -> None:
        self.seconds = 0.0

    def look(self, elapsed_s: float) -> None:
        """Nothing new, so long after the look before."""
        self.seconds += min(max(elapsed_s, 0.0), self._longest_look_s)


class News:
    """Wakes whoever waits for the vehicle's next word."""

    def __init__(self) -> None:
        self._event = asyncio.Event()

    def tell(self) -> None:
        self._event.set()

    async def wait(self, wall_s: float = 0.1) -> None:
        """Until there is news, or so many wall seconds. News told before the call does not count: look first."""
        self._event.clear()
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(wall_s):
                await self._event.wait()


class Announcer:
    """Hands each line to every listener; a listener that sleeps loses the oldest, never delays anybody."""

    def __init__(self, depth: int = 200) -> None:
        self._depth = depth
        self._queues: set[asyncio.Queue[str | None]] = set()

    def say(self, line: str) -> None:
        for queue in self._queues:
            if queue.full():
                queue.get_nowait()
            queue.put_nowait(line)

    def listen(self) -> asyncio.Queue[str | None]:
        """Lines from now on; None is the end. `forget` it when done."""
        queue: asyncio.Queue[str | None] = asyncio.Queue(self._depth)
        self._queues.add(queue)
        return queue

    def forget(self, queue: asyncio.Queue[str | None]) -> None:
        self._queues.discard(queue)

    def end(self) -> None:
        for queue in self._queues:
            if queue.full():
                queue.get_nowait()
            queue.put_nowait(None)
