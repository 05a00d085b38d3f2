"""The way from a running mission to the journal: one writer, in order, and nothing is shown before it is durable.

The machine never waits for the disk; a command to the vehicle is not held up by a slow database.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable, Sequence

from backend.events import Event, Recorded
from backend.ports import FactRefused, Journal, JournalUnavailable, Publisher

log = logging.getLogger("crossfix.mission")

RETRY_S = 0.5

Work = Callable[[], Awaitable[None]]
OnShown = Callable[[Sequence[Recorded]], None]


class Outbox:
    """A write that failed is tried again until it succeeds, and what comes after waits behind it. What the journal
    refuses for good is kept aside, told once to `on_refused`, and holds up nothing."""

    def __init__(
        self,
        mission_id: str,
        journal: Journal,
        publisher: Publisher,
        last_seq: int,
        on_refused: Callable[[str], object] | None = None,
    ) -> None:
        self._mission_id = mission_id
        self._journal = journal
        self._publisher = publisher
        self._on_refused = on_refused
        self._waiting: asyncio.Queue[Work] = asyncio.Queue()
        self._writer: asyncio.Task[None] | None = None
        self.last_seq = last_seq
        self.failing = False
        self.refused = 0

    def record(self, events: Sequence[Event], on_shown: OnShown | None = None) -> None:
        """Append together, then show. When the journal refuses them together, each by itself.

        on_shown: called with what was appended, right after it was shown: what belongs to an event goes out with it.
        """

        async def append() -> None:
            try:
                await self._append(events, on_shown)
            except FactRefused:
                for event in events:
                    await self._append_or_keep_aside(event, on_shown)

        if events:
            self.after(append)

    async def _append(self, events: Sequence[Event], on_shown: OnShown | None) -> None:
        recorded = await self._journal.append(self._mission_id, events)
        self.last_seq = recorded[-1].seq
        self._publisher.events(recorded)
        if on_shown is not None:
            on_shown(recorded)

    async def _append_or_keep_aside(self, event: Event, on_shown: OnShown | None) -> None:
        try:
            await self._append([event], on_shown)
        except FactRefused as error:
            await self._journal.keep_aside(self._mission_id, [event], str(error))
            self._refuse(f"{event.kind}: {error}")

    def _refuse(self, detail: str) -> None:
        log.error("mission %s: %s", self._mission_id, detail)
        self.refused += 1
        if self.refused == 1 and self._on_refused is not None:
            self._on_refused(detail)

    def after(self, work: Work) -> None:
        """Do this once everything before is durable."""
        self._waiting.put_nowait(work)
        if self._writer is None:
            self._writer = asyncio.create_task(self._write())

    async def flushed(self, patience_s: float | None = None) -> None:
        """Returns when everything handed in so far is durable and shown, whatever is handed in meanwhile. Where nothing
        can be stored, after patience_s; None: never."""
        reached = asyncio.Event()

        async def mark() -> None:
            reached.set()

        self.after(mark)
        await self._done(reached.wait, patience_s)

    async def close(self, patience_s: float | None = None) -> None:
        """Everything handed in is written first; where nothing can be stored it is lost after patience_s. What still
        comes afterwards is written too."""
        if not await self._done(self._waiting.join, patience_s):
            log.error("mission %s: what waited to be stored is lost, since nothing could be", self._mission_id)
            self._waiting = asyncio.Queue()
        if self._writer is not None:
            writer, self._writer = self._writer, None
            writer.cancel()
            await asyncio.gather(writer, return_exceptions=True)

    async def _done(self, waited_for: Callable[[], Awaitable[object]], patience_s: float | None) -> bool:
        while True:
            try:
                async with asyncio.timeout(patience_s):
                    await waited_for()
                return True
            except TimeoutError:
                if self.failing:
                    return False

    async def _write(self) -> None:
        while True:
            work = await self._waiting.get()
            while True:
                try:
                    await work()
                    break
                except (JournalUnavailable, OSError) as error:
                    if not self.failing:
                        log.error("mission %s: a fact could not be written, trying again: %s", self._mission_id, error)
                    self.failing = True
                    await asyncio.sleep(RETRY_S)
                except Exception as error:
                    log.exception("mission %s: it cannot be written", self._mission_id)
                    self._refuse(str(error))
                    break
            self.failing = False
            self._waiting.task_done()
