"""The migrations make the very tables that the code uses, and SQLite is set to keep what it acknowledged."""

from __future__ import annotations

import asyncio
import sqlite3
import threading
import time
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import Connection

from backend.store.engine import dispose, make_engine, migrate
from backend.store.tables import metadata


async def test_the_migrated_schema_is_the_one_the_code_uses(database_url):
    await migrate(database_url)
    engine = make_engine(database_url, 1.0)

    def differences(connection: Connection) -> list:
        return compare_metadata(MigrationContext.configure(connection, opts={"compare_type": True}), metadata)

    async with engine.connect() as connection:
        assert await connection.run_sync(differences) == []
    await engine.dispose()


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
async def test_a_commit_on_sqlite_is_on_the_disk(database_url):
    engine = make_engine(database_url, 1.0)
    async with engine.connect() as connection:
        for pragma, value in (("journal_mode", "wal"), ("synchronous", 2), ("foreign_keys", 1), ("busy_timeout", 600)):
            assert (await connection.exec_driver_sql(f"PRAGMA {pragma}")).scalar() == value
    await engine.dispose()


COUNTS = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 5000000) SELECT max(i) FROM n"
"""For longer than anybody here waits."""


def threads_of_connections() -> list[threading.Thread]:
    return [thread for thread in threading.enumerate() if "_connection_worker_thread" in thread.name]


@pytest.mark.parametrize("while_it", ["opens", "reads"])
def test_no_connection_that_was_cut_off_answers_to_a_loop_that_has_ended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, while_it: str
) -> None:
    """As at the end of a server: the tasks beside it are cancelled, then its engine is disposed of."""
    begun, connect = threading.Event(), sqlite3.connect

    def slowly(*args: object, **named: object) -> sqlite3.Connection:
        if while_it == "opens":
            begun.set()
            time.sleep(0.5)
        return connect(*args, **named)  # type: ignore[arg-type]

    monkeypatch.setattr(sqlite3, "connect", slowly)

    async def work() -> list[threading.Thread]:
        engine = make_engine(f"sqlite+aiosqlite:///{tmp_path / 'x.sqlite'}", 60.0)

        async def read() -> None:
            async with engine.connect() as connection:
                begun.set()
                await connection.exec_driver_sql(COUNTS)

        reading = asyncio.create_task(read())
        await asyncio.to_thread(begun.wait)
        await asyncio.sleep(0.05)
        reading.cancel()
        await asyncio.gather(reading, return_exceptions=True)
        await dispose(engine)
        return threads_of_connections()

    before = threads_of_connections()
    assert set(asyncio.run(work())) <= set(before)
