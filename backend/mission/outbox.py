"""The way from a running mission to the journal: one writer, in order, and nothing is shown before it is durable.

The machine never waits for the disk; a command to the vehicle is not held up by a slow database.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable, Sequence

from backend.events import Event
from backend.mission.ports import Journal, Publisher

log = logging.getLogger("crossfix.mission")

RETRY_S = 0.5

Work = Callable[[], Awaitable[None]]


class Outbox:
    """Writes that failed are tried again until they succeed; what comes after waits behind them."""

    def __init__(self, mission_id: str, journal: Journal, publisher: Publisher, last_seq: int) -> None:
        self._mission_id = mission_id
        self._journal = journal
        self._publisher = publisher
        self._waiting: asyncio.Queue[Work] = asyncio.Queue()
        self._writer: asyncio.Task[None] | None = None
        self.last_seq = last_seq
        self.failing = False

    def record(self, events: Sequence[Event]) -> None:
        """Append together, then show."""

        async def append() -> None:
            recorded = await self._journal.append(self._mission_id, events)
            self.last_seq = recorded[-1].seq
            self._publisher.events(recorded)

        if events:
            self.after(append)

    def after(self, work: Work) -> None:
        """Do this once everything before is durable."""
        self._waiting.put_nowait(work)
        if self._writer is None:
            self._writer = asyncio.create_task(self._write())

    async def flushed(self) -> None:
        """Returns when everything handed in so far is durable and shown."""
        await self._waiting.join()

    async def close(self) -> None:
        """Everything handed in is written first. What still comes afterwards is written too."""
        await self.flushed()
        if self._writer is not None:
            writer, self._writer = self._writer, None
            writer.cancel()
            await asyncio.gather(writer, return_exceptions=True)

    async def _write(self) -> None:
        while True:
            work = await self._waiting.get()
            while True:
                try:
                    await work()
                    break
                except Exception:
                    if not self.failing:
                        log.exception("mission %s: a fact could not be written, trying again", self._mission_id)
                    self.failing = True
                    await asyncio.sleep(RETRY_S)
            self.failing = False
            self._waiting.task_done()
