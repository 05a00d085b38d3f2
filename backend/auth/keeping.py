"""What the registers of people, sessions, invitations and tokens share: where rows are kept, and two clocks.

All of it is in memory and written through: a database that is away lets everybody who is signed in go on, and an abort
waits for no query. Inside one run of the server only the monotonic clock counts: a clock that jumps, as that of a field
laptop does when it first hears a satellite, neither signs anybody out in flight nor brings a session back.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field

from backend.auth.records import Records, Row, RowThere
from backend.auth.registry import Invitation, Person
from backend.ports import JournalUnavailable
from backend.reasons import Reason
from planner.reason import ReasonedError

log = logging.getLogger("crossfix.access")

REMOVE_EVERY_S = 5.0
"""So often the database is asked again to remove what has ended."""


class Denied(ReasonedError):
    """status: of the answer."""

    def __init__(self, status: int, reason: Reason) -> None:
        super().__init__(reason)
        self.status = status


@dataclass(slots=True)
class Keeping:
    """records None: nothing is kept (a server on paper, for tests of other things).

    changing: held by whoever looks at the registers and then changes them. in_doubt: the database may hold a change of
    people or invitations that memory does not know.
    """

    records: Records | None
    wall_s: Callable[[], float] = time.time
    monotonic_s: Callable[[], float] = time.monotonic
    changing: asyncio.Lock = field(default_factory=asyncio.Lock)
    in_doubt: bool = False
    _writing: set[asyncio.Task[None]] = field(default_factory=set[asyncio.Task[None]])
    _left: list[Row] = field(default_factory=list[Row])
    _removing: asyncio.Task[None] | None = None

    def now_us(self) -> int:
        """UTC microseconds."""
        return int(self.wall_s() * 1e6)

    async def change(self, *, new: Iterable[Row] = (), now: Iterable[Row] = (), gone: Iterable[Row] = ()) -> None:
        """All or nothing, see Records.change. Raises JournalUnavailable."""
        if self.records is not None:
            new, now, gone = tuple(new), tuple(now), tuple(gone)
            try:
                await self.records.change(new=new, now=now, gone=gone)
            except (JournalUnavailable, RowThere):
                self.in_doubt |= any(isinstance(row, Person | Invitation) for row in (*new, *now))
                raise

    async def remove(self, rows: Iterable[Row]) -> None:
        """What the database does not take now it is asked again until it does: a row that stayed would let somebody in
        again after a restart. Raises JournalUnavailable when it is not done yet."""
        self._left += rows
        try:
            await self._remove_left()
        except JournalUnavailable:
            if self._removing is None or self._removing.done():
                self._removing = asyncio.create_task(self._remove_later())
            raise

    async def _remove_left(self) -> None:
        gone = tuple(self._left)
        await self.change(gone=gone)
        self._left = [row for row in self._left if row not in gone]

    async def _remove_later(self) -> None:
        while self._left:
            await asyncio.sleep(REMOVE_EVERY_S)
            with suppress(JournalUnavailable):
                await self._remove_left()

    def change_quietly(self, row: Row) -> None:
        """In the background; a database that is away is only logged."""
        task = asyncio.create_task(self._write_quietly(row))
        self._writing.add(task)
        task.add_done_callback(self._writing.discard)

    async def close(self) -> None:
        """What waits is written."""
        await asyncio.gather(*self._writing, return_exceptions=True)
        if self._removing is not None:
            self._removing.cancel()
            await asyncio.gather(self._removing, return_exceptions=True)
        if self._left:
            try:
                await self._remove_left()
            except JournalUnavailable as error:
                log.error("%d sessions that were ended are still stored: %s", len(self._left), error)
        if self.records is not None:
            await self.records.close()

    async def _write_quietly(self, row: Row) -> None:
        try:
            await self.change(now=(row,))
        except JournalUnavailable as error:
            log.info("the last use of a session was not written down: %s", error)
