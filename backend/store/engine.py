"""The database connection: SQLite that keeps what it acknowledged, or PostgreSQL; and the migrations."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from threading import Thread
from typing import Any
from weakref import WeakKeyDictionary

import aiosqlite
from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import URL, Connection, Dialect, Engine, create_engine, event, make_url
from sqlalchemy.ext.asyncio import AsyncEngine, create_async_engine
from sqlalchemy.pool import NullPool

MIGRATIONS = Path(__file__).resolve().parent.parent.parent / "migrations"


class LaterSchema(ValueError):
    """The database is of a schema that this version does not know. revision: its."""

    def __init__(self, revision: str) -> None:
        super().__init__(f"its schema {revision} is of a later Crossfix")
        self.revision = revision


SHORTER = 0.6
"""Of the caller's time for an answer: how long SQLite waits for a locked file."""


def make_engine(url: str | URL, timeout_s: float) -> AsyncEngine:
    """`url` with its async driver. On SQLite a locked file is waited for less long than `timeout_s`, so that SQLite
    answers before the caller gives up."""
    sqlite = make_url(url).get_backend_name() == "sqlite"
    if sqlite:
        _make_folder(url)
        engine = create_async_engine(url, connect_args={"timeout": SHORTER * timeout_s})
        _configure_sqlite(engine.sync_engine)
        _keep_threads(engine.sync_engine)
        return engine
    engine = create_async_engine(
        url,
        pool_pre_ping=True,
        pool_size=5,
        pool_timeout=timeout_s,
        connect_args={"timeout": timeout_s, "server_settings": {"application_name": "crossfix"}},
    )
    for ends in ("invalidate", "close"):
        event.listen(engine.sync_engine, ends, _cut_off)
    return engine


def _cut_off(connection: Any, *_: Any) -> None:
    """No connection is closed in good order: beside a PostgreSQL that hangs SQLAlchemy would wait two seconds for one
    that is given up, and without end for one that is idle."""
    connection.driver_connection.terminate()


def make_writing_engine(engine: AsyncEngine, timeout_s: float) -> AsyncEngine | None:
    """On the same PostgreSQL, with connections that no reader takes: a crowd of them would else keep facts from being
    stored. None on SQLite, where a direct engine writes."""
    return None if engine.dialect.name == "sqlite" else make_engine(engine.url, timeout_s)


def make_direct_engine(engine: AsyncEngine, timeout_s: float) -> Engine:
    """On the same SQLite file, for one thread that does whole transactions by itself."""
    url = engine.url.set(drivername="sqlite")
    direct = create_engine(url, connect_args={"timeout": SHORTER * timeout_s})
    _configure_sqlite(direct)
    return direct


_opened: WeakKeyDictionary[Dialect, list[aiosqlite.Connection]] = WeakKeyDictionary()
"""Every connection to SQLite whose thread may run, by what all variants of an engine share."""
ENDS_S = 5.0


def _keep_threads(engine: Engine) -> None:
    """Each connection to SQLite is a thread, which answers to the event loop; also one whose caller has given up."""
    known = _opened.setdefault(engine.dialect, [])

    def connect(*args: Any, **named: Any) -> aiosqlite.Connection:
        connection = aiosqlite.connect(*args, **named)
        _thread(connection).daemon = True
        known[:] = [one for one in known if _thread(one).ident is None or _thread(one).is_alive()]
        known.append(connection)
        return connection

    @event.listens_for(engine, "do_connect")
    def with_thread(_dialect: Dialect, _record: Any, _args: Any, named: dict[str, Any]) -> None:
        named["async_creator_fn"] = connect


async def dispose(engine: AsyncEngine) -> None:
    """The engine's connections are closed when it returns, those too of whoever was cut off in the middle: the thread
    of such a one would else answer to an event loop that has ended. One that was cut off while it was set up is in no
    pool, and closed by nobody else."""
    await engine.dispose()
    left = [connection for connection in _opened.get(engine.dialect, []) if _thread(connection).is_alive()]
    for connection in left:
        await connection.close()
    if left:
        await asyncio.to_thread(_join, map(_thread, left))


def _thread(connection: aiosqlite.Connection) -> Thread:
    return connection._thread  # pyright: ignore[reportPrivateUsage] (as SQLAlchemy does)


def _join(threads: Iterable[Thread]) -> None:
    until = time.monotonic() + ENDS_S
    for thread in threads:
        thread.join(max(0.0, until - time.monotonic()))


def _make_folder(url: str | URL) -> None:
    database = make_url(url).database
    if database and database != ":memory:":
        path = Path(database)
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() and not database.startswith("file:"):
            with suppress(OSError):  # SQLite says what is wrong
                path.touch(0o600)  # it holds what passwords and sessions are known by; SQLite's files beside it follow


def _configure_sqlite(engine: Engine) -> None:
    """WAL and synchronous=FULL: a commit that returned survives a power cut. A transaction that will write says so at
    its beginning (execution option `write`), else two of them could deadlock on the upgrade of their lock. lower()
    knows all letters, as PostgreSQL's does: a search finds "Übung" by "übung"."""

    @event.listens_for(engine, "connect")
    def set_pragmas(connection: Any, _record: Any) -> None:
        connection.isolation_level = None
        cursor = connection.cursor()
        for pragma in ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON"):
            cursor.execute(f"PRAGMA {pragma}")
        cursor.close()
        connection.create_function("lower", 1, _lower, deterministic=True)

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        write = connection.get_execution_options().get("write", False)
        connection.exec_driver_sql("BEGIN IMMEDIATE" if write else "BEGIN")


def _lower(text: Any) -> str | None:
    return None if text is None else str(text).lower()


def database_missing(url: str) -> str | None:
    """A sentence when an SQLite file is not there, which opening it would make; None: it is, or is no file."""
    found = make_url(url)
    if found.get_backend_name() != "sqlite" or Path(found.database or "").is_file():
        return None
    here = "name the server's data directory (--data-dir) or database (--database)"
    return f"there is no database {found.database}: {here}"


def engine_for_once(url: str, timeout_s: float) -> AsyncEngine:
    """For a command that works beside the server: its connections are closed as soon as they are given back."""
    engine = create_async_engine(url, poolclass=NullPool, connect_args={"timeout": timeout_s})
    if make_url(url).get_backend_name() == "sqlite":
        _make_folder(url)
        _configure_sqlite(engine.sync_engine)
        _keep_threads(engine.sync_engine)
    return engine


async def migrate(url: str, timeout_s: float = 30.0, revision: str = "head") -> None:
    """Bring the database to the current schema, or to an earlier revision of it on the way there. In a thread of its
    own: Alembic is synchronous. Raises LaterSchema."""
    await asyncio.to_thread(_migrate_in_thread, url, timeout_s, revision)


def bring_forward(connection: Connection) -> None:
    """To the current schema, within the caller's transaction. Raises LaterSchema, and whatever a row that no Crossfix
    wrote brings about."""
    _run_alembic(connection, "head")


async def shrink(engine: AsyncEngine) -> None:
    """Give the file's unused pages back to the disk. SQLite only; nobody else may use the file."""
    async with engine.connect() as connection:
        driver = (await connection.get_raw_connection()).driver_connection
        assert driver is not None
        await driver.execute("VACUUM")  # allowed outside a transaction only


def known_revisions() -> frozenset[str]:
    """Of the schemas that this version can bring up to date."""
    return frozenset(script.revision for script in ScriptDirectory.from_config(_config()).walk_revisions())


def _migrate_in_thread(url: str, timeout_s: float, revision: str) -> None:
    asyncio.run(_upgrade(url, timeout_s, revision))


async def _upgrade(url: str, timeout_s: float, revision: str) -> None:
    engine = engine_for_once(url, timeout_s)
    try:
        async with engine.execution_options(write=True).begin() as connection:
            await connection.run_sync(_run_alembic, revision)
    finally:
        await dispose(engine)


def _config() -> Config:
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS).replace("%", "%%"))
    return config


def _run_alembic(connection: Connection, revision: str) -> None:
    config = _config()
    there = MigrationContext.configure(connection).get_current_revision()
    if there is not None and there not in known_revisions():
        raise LaterSchema(there)
    if there is None:
        _require_unicode(connection)
    config.attributes["connection"] = connection
    command.upgrade(config, revision)


def _require_unicode(connection: Connection) -> None:
    """A new database that lacks most letters is refused at once, not with the first name that has one. Raises
    ValueError."""
    if connection.dialect.name != "postgresql":
        return
    encoding = connection.exec_driver_sql("SHOW server_encoding").scalar_one()
    if encoding != "UTF8":
        raise ValueError(f"its encoding is {encoding}; make it with ENCODING 'UTF8' TEMPLATE template0")
