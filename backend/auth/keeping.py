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
from dataclasses import dataclass, field

from backend.auth.records import Records, Row
from backend.ports import JournalUnavailable
from backend.reasons import Reason
from planner.reason import ReasonedError

log = logging.getLogger("crossfix.access")


class Denied(ReasonedError):
    """status: of the answer."""

    def __init__(self, status: int, reason: Reason) -> None:
        super().__init__(reason)
        self.status = status


@dataclass(slots=True)
class Keeping:
    """records None: nothing is kept (a server on paper, for tests of other things).

    changing: held by whoever looks at the registers and then changes them.
    """

    records: Records | None
    wall_s: Callable[[], float] = time.time
    monotonic_s: Callable[[], float] = time.monotonic
    changing: asyncio.Lock = field(default_factory=asyncio.Lock)
    _writing: set[asyncio.Task[None]] = field(default_factory=set[asyncio.Task[None]])

    def now_us(self) -> int:
        """UTC microseconds."""
        return int(self.wall_s() * 1e6)

    async def change(self, *, new: Iterable[Row] = (), now: Iterable[Row] = (), gone: Iterable[Row] = ()) -> None:
        """All or nothing, see Records.change. Raises JournalUnavailable."""
        if self.records is not None:
            await self.records.change(new=tuple(new), now=tuple(now), gone=tuple(gone))

    def change_quietly(self, row: Row) -> None:
        """In the background; a database that is away is only logged."""
        task = asyncio.create_task(self._write_quietly(row))
        self._writing.add(task)
        task.add_done_callback(self._writing.discard)

    async def close(self) -> None:
        """What waits is written."""
        await asyncio.gather(*self._writing, return_exceptions=True)
        if self.records is not None:
            await self.records.close()

    async def _write_quietly(self, row: Row) -> None:
        try:
            await self.change(now=(row,))
        except JournalUnavailable as error:
            log.info("the last use of a session was not written down: %s", error)
