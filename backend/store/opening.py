"""A journal ready for use: schema migrated, spool of an earlier outage drained, watched in the background."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncGenerator, Callable, Generator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

from sqlalchemy import make_url
from sqlalchemy.exc import DBAPIError

from backend.reasons.storage import AnotherServer, DatabaseLater, DatabaseUnfit, ForeignSpool
from backend.settings import Settings
from backend.store.days_seen import DaysSeen
from backend.store.engine import LaterSchema, make_engine, migrate
from backend.store.iq_folder import IqFolder
from backend.store.journal import SqlJournal
from backend.store.reading import why
from backend.store.retention import keep_thin
from backend.store.spool import Spool, SpoolForeign, SpoolTaken, claim
from backend.store.told_folder import ToldFolder
from backend.store.ways_files import WaysFiles
from planner.reason import ReasonedError

log = logging.getLogger("crossfix.store")

CLAIM_PATIENCE_S = 3.0
MIGRATES_S = 30.0
"""So long a database that does not answer is waited for."""


class DatabaseUnusable(ReasonedError, RuntimeError):
    """The server cannot start."""

    def __init__(self, reason: DatabaseUnfit | DatabaseLater | AnotherServer | ForeignSpool) -> None:
        super().__init__(reason)


@asynccontextmanager
async def open_journal(settings: Settings, now: Callable[[], float]) -> AsyncGenerator[SqlJournal]:
    """`now`: UTC epoch seconds of the mission's clock, stamped on every event. Raises DatabaseUnusable."""
    url = settings.async_database_url
    with claimed(url):
        async with _opened(settings, url, now) as journal:
            yield journal


@contextmanager
def claimed(url: str) -> Generator[None]:
    """One server an SQLite file: two would fly and record the same mission. Raises DatabaseUnusable.

    (A stale lock in PostgreSQL could keep a server out that restarts in flight; there the journal finds a second writer
    by its sequence numbers.)
    """
    database = make_url(url).database
    if make_url(url).get_backend_name() != "sqlite" or not database or database == ":memory:":
        yield
        return
    path = Path(f"{database}.server")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        lock = path.open("w")
    except OSError as error:
        raise DatabaseUnusable(DatabaseUnfit(database, why(error))) from error
    with lock:
        try:
            claim(lock.fileno(), CLAIM_PATIENCE_S)
        except SpoolTaken:
            raise DatabaseUnusable(AnotherServer(database)) from None
        yield


@asynccontextmanager
async def _opened(settings: Settings, url: str, now: Callable[[], float]) -> AsyncGenerator[SqlJournal]:
    shown = settings.shown_database
    try:
        await _migrated(url, shown, settings.database_timeout_s)
        spool = await asyncio.to_thread(Spool, settings.spool_path, settings.spool_reserve_bytes, CLAIM_PATIENCE_S)
    except SpoolTaken as error:
        raise DatabaseUnusable(AnotherServer(str(settings.spool_path))) from error
    except SpoolForeign as error:
        raise DatabaseUnusable(ForeignSpool(str(settings.spool_path))) from error
    except LaterSchema as error:
        raise DatabaseUnusable(DatabaseLater(shown, error.revision)) from error
    except (DBAPIError, OSError, ValueError) as error:
        raise DatabaseUnusable(DatabaseUnfit(shown, why(error))) from error
    engine = make_engine(url, settings.database_timeout_s)
    journal = SqlJournal(
        engine,
        spool,
        now,
        timeout_s=settings.database_timeout_s,
        slow_s=settings.database_slow_s,
        disk_low_bytes=settings.disk_low_bytes,
    )
    beside: list[asyncio.Task[None]] = []
    try:
        await journal.start_up()
        beside.append(asyncio.create_task(journal.run()))
        others = ToldFolder.of_settings(settings), WaysFiles.of_settings(settings)
        seen, iq = (DaysSeen.deleted(settings), DaysSeen.old(settings)), IqFolder.of_settings(settings)
        beside.append(asyncio.create_task(keep_thin(engine, settings.keep_sweeps_days, seen, iq, *others)))
        yield journal
    finally:
        for task in beside:
            task.cancel()
        await asyncio.gather(*beside, return_exceptions=True)
        await journal.close()


async def _migrated(url: str, shown: str, soon_s: float) -> None:
    """Whoever starts the server hears what it waits for. Raises what `migrate` does."""
    task = asyncio.create_task(migrate(url, MIGRATES_S))
    _, waiting = await asyncio.wait({task}, timeout=soon_s)
    if waiting:
        log.warning(
            "waiting for the database %s: it does not answer yet (%.0f s at most), or its tables are being brought up "
            "to date",
            shown,
            MIGRATES_S,
        )
    await task
