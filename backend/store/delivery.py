"""How entries reach the database: written at once, or spooled on disk while it is away and drained when it is back.

`store` returns only when an entry is durable in one of the two. `run` watches the database, and no error ends it: what
it did not foresee is logged and counts as a database that is away, and an entry that fails again and again while the
database answers is kept aside, so that it holds up nothing behind it.
"""

from __future__ import annotations

import asyncio
import logging
import shutil
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Literal

from sqlalchemy import Connection, exc, text
from sqlalchemy.ext.asyncio import AsyncEngine

from backend.ports import FactRefused, JournalUnavailable
from backend.reasons.storage import DatabaseSilent, DatabaseSlow, DiskLow, FactUnfit, NothingStores
from backend.store.engine import dispose, make_writing_engine
from backend.store.entries import Entry, EventsEntry, JournalConflict, decode
from backend.store.patience import patience
from backend.store.reading import Unanswered, refuses, unanswered, why
from backend.store.spool import Spool, SpoolFull
from backend.store.transactions import transactions_of
from planner.reason import text_of

log = logging.getLogger("crossfix.store")

RETRY_FIRST_S, RETRY_LAST_S = 0.25, 5.0
RETRY_BUSY_S = 1.0
"""Nobody is away: there is only little time for each try."""
PROBE_S = 1.0
DRAIN_BATCH = 64
MOST_TRIES = 5
"""Of an entry whose writing fails in a way that nobody foresaw."""

REFUSED = (JournalConflict, exc.IntegrityError, exc.DataError, exc.ProgrammingError)
"""The database answered, and will never take this entry."""


class DatabaseAway(RuntimeError):
    """The database did not answer; nothing is known about the last transaction."""

    def __init__(self, reason: Unanswered) -> None:
        super().__init__(_words(reason))
        self.reason = reason


def _words(fault: Unanswered) -> str:
    return fault.detail if isinstance(fault, DatabaseSilent) else text_of(fault).rstrip(".")


@dataclass(frozen=True, slots=True)
class DatabaseReport:
    """lost: it is not reached. slow: it, its disk or this machine is, however long the spool must wait. reason: None
    when all is well. spooled: entries on disk that wait for the database. refused: entries that it will never take
    (kept in a file)."""

    state: Literal["ok", "slow", "lost"]
    reason: Unanswered | NothingStores | DatabaseSlow | DiskLow | None
    spooled: int
    refused: int


class Delivery:
    """Of one server. settled: called when the last spooled entry is stored, before anything else is."""

    def __init__(
        self,
        engine: AsyncEngine,
        spool: Spool,
        settled: Callable[[], None],
        *,
        timeout_s: float,
        slow_s: float,
        disk_low_bytes: int,
    ) -> None:
        self._own = make_writing_engine(engine, timeout_s)
        self._engine = engine if self._own is None else self._own
        self._transactions = transactions_of(self._engine, timeout_s)
        self._spool = spool
        self._settled = settled
        self._timeout_s = timeout_s
        self._slow_s = slow_s
        self._disk_low_bytes = disk_low_bytes
        self._lock = asyncio.Lock()
        self._wake = asyncio.Event()
        self._fault: Unanswered | None = None
        self._spool_fault: str | None = None
        self._answers = True
        self._at_once = DRAIN_BATCH
        self._took_s = 0.0
        self._refused = 0
        self._tries = 0
        self._disk_free_bytes: int | None = None
        self.waiting: deque[Entry] = deque()
        """In the spool, oldest first."""
        for payload in spool.entries():
            self._take_up(payload)

    def _take_up(self, payload: bytes) -> None:
        """An entry of an earlier server; one that cannot be read stops no start."""
        try:
            self.waiting.append(decode(payload))
        except Exception:
            log.exception("an entry of the spool cannot be read; it is kept aside")
            self._refused += 1
            self._spool.keep_aside(payload)

    # Writing

    async def store(self, entry: Entry) -> None:
        """To the database, or behind what already waits in the spool.

        Raises JournalUnavailable when neither takes it, FactRefused, JournalConflict.
        """
        async with self._lock:
            if not self.waiting and self._fault is None:
                try:
                    await self._write([entry])
                except DatabaseAway as error:
                    self.lost(error)
                except JournalConflict:
                    raise
                except REFUSED as error:
                    raise FactRefused(FactUnfit("database", why(error))) from error
                else:
                    return
            try:
                await asyncio.to_thread(self._spool.append, entry.encode())
            except SpoolFull as error:
                self._spool_fault = str(error)
                raise JournalUnavailable(self._nothing_stores(self._spool_fault)) from error
            self._spool_fault = None
            self.waiting.append(entry)
            self._wake.set()

    async def _write(self, entries: Sequence[Entry]) -> None:
        """All in one transaction. Raises DatabaseAway, and what `REFUSED` names."""
        began = time.monotonic()
        try:
            async with patience(self._timeout_s):
                await self._transactions.run(partial(_write, entries))
        except REFUSED:
            raise
        except exc.DBAPIError as error:
            if refuses(error):
                raise exc.DataError(error.statement, error.params, error.orig or error) from error
            raise DatabaseAway(unanswered(error, self._engine)) from error
        except (exc.TimeoutError, OSError) as error:
            raise DatabaseAway(unanswered(error, self._engine)) from error
        finally:
            self._took_s = time.monotonic() - began

    async def set_aside(self, entry: Entry, reason: str) -> None:
        """For a person to look at, in a file beside the spool; counted in the report."""
        self._refused += 1
        log.error("kept aside, it cannot be stored: %s", reason)
        try:
            await asyncio.to_thread(self._spool.keep_aside, entry.encode())
        except OSError as error:
            log.error("it could not be kept aside either (%s): %s", error.strerror, entry.encode().decode())

    # Being away and coming back

    def lost(self, error: Exception) -> None:
        """From now on entries go to the spool, until it is drained."""
        fault = error.reason if isinstance(error, DatabaseAway) else DatabaseSilent(why(error))
        if type(fault) is not type(self._fault):
            level = logging.ERROR if isinstance(fault, DatabaseSilent) else logging.WARNING
            log.log(level, "not stored: %s; events are spooled", _words(fault))
        self._fault, self._answers = fault, False
        self._wake.set()

    async def run(self) -> None:
        """Watch the database, and drain the spool when it is back. Runs until cancelled, whatever happens."""
        retry_s = RETRY_FIRST_S
        while True:
            try:
                if self.waiting or self._fault is not None:
                    await self.drain()
                    retry_s = RETRY_FIRST_S
                else:
                    await self._look()
                continue
            except DatabaseAway as error:
                self.lost(error)
            except Exception as error:
                log.exception("the watch over the database met what it did not foresee; it goes on")
                self.lost(error)
            await asyncio.sleep(retry_s)
            retry_s = min(2 * retry_s, RETRY_LAST_S if isinstance(self._fault, DatabaseSilent) else RETRY_BUSY_S)

    async def _look(self) -> None:
        """At the disk and, unless something happens first, at the database a while later."""
        self._disk_free_bytes = _free_bytes(self._spool.path)
        self._wake.clear()
        try:
            async with asyncio.timeout(PROBE_S):
                await self._wake.wait()
        except TimeoutError:
            await self._probe()

    async def _probe(self) -> None:
        began = time.monotonic()
        try:
            async with patience(self._timeout_s), self._engine.connect() as connection:
                await connection.execute(text("SELECT 1"))
        except (exc.DBAPIError, exc.TimeoutError, OSError) as error:
            raise DatabaseAway(unanswered(error, self._engine)) from error
        self._took_s = time.monotonic() - began

    async def drain(self) -> None:
        """Everything that waits, in order; what is stored meanwhile queues up behind it. Raises DatabaseAway."""
        await self._probe()
        drained = 0
        while self.waiting:
            batch = list(islice(self.waiting, 1 if self._tries else self._at_once))
            try:
                await self._write(batch)
            except REFUSED:
                del batch[1:]
                await self._write_or_set_aside(batch[0])
            except DatabaseAway:
                self._at_once = max(1, len(batch) // 2)  # fewer are done in time
                raise
            except Exception as error:
                if not await self._given_up(batch, error):
                    raise
            self._tries = 0
            self._at_once = min(2 * self._at_once, DRAIN_BATCH)
            drained += len(batch)
            self._answers = True  # slow until the rest is stored, but away no longer
            for _ in batch:
                self.waiting.popleft()
        async with self._lock:
            if not self.waiting:
                await self._clear_spool()
                if self._fault is not None:
                    log.warning("%d spooled entries stored: nothing waits any more", drained)
                self._fault = None
                self._settled()

    async def _clear_spool(self) -> None:
        """Raises DatabaseAway: who answers a question, on a disk that cannot be written, is not back."""
        try:
            await asyncio.to_thread(self._spool.clear)
        except OSError as error:
            self._spool_fault = error.strerror or why(error)
            raise DatabaseAway(self._fault or DatabaseSilent(self._spool_fault)) from error
        self._spool_fault = None

    def _nothing_stores(self, spool: str) -> NothingStores:
        return NothingStores("it still takes what waited" if self._fault is None else _words(self._fault), spool)

    async def _write_or_set_aside(self, entry: Entry) -> None:
        try:
            await self._write([entry])
        except REFUSED as error:
            await self.set_aside(entry, f"the database refuses a spooled entry: {error}")

    async def _given_up(self, batch: Sequence[Entry], error: Exception) -> bool:
        """An entry alone that failed often enough, although the database answered before each try, is set aside."""
        self._tries += 1
        if len(batch) > 1 or self._tries <= MOST_TRIES:
            return False
        await self.set_aside(batch[0], f"a spooled entry fails again and again ({type(error).__name__}: {error})")
        return True

    async def close(self) -> None:
        """Its own connections to the database."""
        await self._transactions.close()
        if self._own is not None:
            await dispose(self._own)

    def waiting_events(self, mission_id: str) -> list[EventsEntry]:
        """Of a mission, in order."""
        return [entry for entry in self.waiting if isinstance(entry, EventsEntry) and entry.mission_id == mission_id]

    def report(self) -> DatabaseReport:
        """From what the last attempts showed; asks nobody."""
        waiting = len(self.waiting)
        if self._fault is not None and self._spool_fault is not None:
            return DatabaseReport("lost", self._nothing_stores(self._spool_fault), waiting, self._refused)
        if self._fault is not None and not isinstance(self._fault, DatabaseSilent):
            return DatabaseReport("slow", self._fault, waiting, self._refused)
        if self._fault is not None and not self._answers:
            return DatabaseReport("lost", self._fault, waiting, self._refused)
        if waiting or self._fault is not None or self._took_s > self._slow_s:
            return DatabaseReport("slow", DatabaseSlow(self._took_s), waiting, self._refused)
        if self._disk_free_bytes is not None and self._disk_free_bytes < self._disk_low_bytes:
            return DatabaseReport("slow", DiskLow(self._disk_free_bytes), 0, self._refused)
        return DatabaseReport("ok", None, 0, self._refused)


def _write(entries: Sequence[Entry], connection: Connection) -> None:
    for entry in entries:
        entry.write(connection)


def _free_bytes(path: Path) -> int | None:
    """None where the file system does not say."""
    try:
        return shutil.disk_usage(path).free
    except OSError as error:
        log.debug("the free space beside %s is not known: %s", path, error)
        return None
