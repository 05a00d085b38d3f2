"""A journal ready for use: schema migrated, spool of an earlier outage drained, watched in the background."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

from sqlalchemy import make_url
from sqlalchemy.exc import DBAPIError

from backend.settings import Settings
from backend.store.engine import make_engine, migrate
from backend.store.journal import SqlJournal
from backend.store.spool import Spool, SpoolTaken, claim

CLAIM_PATIENCE_S = 3.0
REMEDY = "Check CROSSFIX_DATABASE_URL and that the disk can be written."


class DatabaseUnusable(RuntimeError):
    """The server cannot start: the message says why and what to try."""


@asynccontextmanager
async def open_journal(settings: Settings, now: Callable[[], float]) -> AsyncIterator[SqlJournal]:
    """`now`: UTC epoch seconds of the mission's clock, stamped on every event. Raises DatabaseUnusable."""
    url = settings.async_database_url
    with _claimed(url):
        async with _opened(settings, url, now) as journal:
            yield journal


@contextmanager
def _claimed(url: str) -> Iterator[None]:
    """One server an SQLite file: two would fly and record the same mission. (A stale lock in PostgreSQL could keep a
    server out that restarts in flight; there the journal finds a second writer by its sequence numbers.)"""
    database = make_url(url).database
    if make_url(url).get_backend_name() != "sqlite" or not database or database == ":memory:":
        yield
        return
    path = Path(f"{database}.server")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        lock = path.open("w")
    except OSError as error:
        raise DatabaseUnusable(f"The database {database} cannot be used: {error}. {REMEDY}") from error
    with lock:
        try:
            claim(lock.fileno(), CLAIM_PATIENCE_S)
        except SpoolTaken:
            raise DatabaseUnusable(
                f"Another server uses the database {database}. Stop it, or start this one with another --data-dir."
            ) from None
        yield


@asynccontextmanager
async def _opened(settings: Settings, url: str, now: Callable[[], float]) -> AsyncIterator[SqlJournal]:
    shown = url.split("@")[-1] if "@" in url else url
    try:
        await migrate(url)
        spool = await asyncio.to_thread(Spool, settings.spool_path, settings.spool_reserve_bytes, CLAIM_PATIENCE_S)
    except SpoolTaken as error:
        raise DatabaseUnusable(
            f"Another server uses {settings.spool_path}. Stop it, or start this one with another --data-dir."
        ) from error
    except (DBAPIError, OSError, ValueError) as error:
        cause = error.orig if isinstance(error, DBAPIError) and error.orig else error
        raise DatabaseUnusable(f"The database {shown} cannot be used: {cause}. {REMEDY}") from error
    journal = SqlJournal(
        make_engine(url, settings.database_timeout_s),
        spool,
        now,
        timeout_s=settings.database_timeout_s,
        slow_s=settings.database_slow_s,
        disk_low_bytes=settings.disk_low_bytes,
    )
    watch: asyncio.Task[None] | None = None
    try:
        await journal.start_up()
        watch = asyncio.create_task(journal.run())
        yield journal
    finally:
        if watch is not None:
            watch.cancel()
            await asyncio.gather(watch, return_exceptions=True)
        await journal.close()
