"""A journal ready for use: schema migrated, spool of an earlier outage drained, watched in the background."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

from sqlalchemy.exc import DBAPIError

from backend.settings import Settings
from backend.store.engine import make_engine, migrate
from backend.store.journal import SqlJournal
from backend.store.spool import Spool


class DatabaseUnusable(RuntimeError):
    """The server cannot start: the message says why and what to try."""


@asynccontextmanager
async def open_journal(settings: Settings, now: Callable[[], float]) -> AsyncIterator[SqlJournal]:
    """`now`: UTC epoch seconds of the mission's clock, stamped on every event. Raises DatabaseUnusable."""
    url = settings.async_database_url
    shown = url.split("@")[-1] if "@" in url else url
    try:
        await migrate(url)
        spool = await asyncio.to_thread(Spool, settings.spool_path, settings.spool_reserve_bytes)
    except (DBAPIError, OSError, ValueError) as error:
        cause = error.orig if isinstance(error, DBAPIError) and error.orig else error
        remedy = "Check CROSSFIX_DATABASE_URL and that the disk can be written."
        raise DatabaseUnusable(f"The database {shown} cannot be used: {cause}. {remedy}") from error
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
        await journal.drain()
        watch = asyncio.create_task(journal.run())
        yield journal
    finally:
        if watch is not None:
            watch.cancel()
            await asyncio.gather(watch, return_exceptions=True)
        await journal.close()
