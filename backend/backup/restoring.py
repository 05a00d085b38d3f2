"""An archive put back onto an empty server: everything or nothing."""

from __future__ import annotations

import asyncio
import os
import shutil
import tempfile
from collections.abc import Callable, Collection, Generator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import Connection, Text, select, text
from sqlalchemy.exc import DBAPIError, SQLAlchemyError
from sqlalchemy.ext.asyncio import AsyncConnection

from backend.backup.archive import Archive
from backend.backup.making import is_database
from backend.backup.manifest import DATABASE, FILES, PATTERN, SPOOL, BackupError, Member, of_the_machine
from backend.backup.rows import VERSION_TABLE, reflected, revision_of, write_lines
from backend.settings import AUDIT_FILE, Settings
from backend.store.engine import bring_forward, dispose, engine_for_once, known_revisions, migrate
from backend.store.opening import DatabaseUnusable, claimed
from backend.store.reading import why
from backend.store.spool import Spool, SpoolForeign, SpoolFull, SpoolTaken, entries_beside
from backend.store.tables import metadata
from planner.reason import sentence_of

ANSWERS_S = 30.0
AUDIT_BEFORE = "audit.before-restore.jsonl"
"""The audit log of a server that has only started stays under this name, beside the one of the archive."""
PACKED_SINCE = "0007"
"""The schema from which on the database may hold compressed bodies of facts."""
PATTERNS = "patterns"
"""The folder of the data directory that an antenna pattern comes back to."""


@dataclass(frozen=True, slots=True)
class Restored:
    """rows: of all tables; pattern: where the antenna pattern lies now, None when the archive holds none."""

    missions: int
    rows: int
    files: int
    pattern: Path | None


def restore(settings: Settings, source: Path, progress: Callable[[str], None] = lambda _: None) -> Restored:
    """Everything of the archive, or an error and nothing. No server may run on the target.

    Blocking, with an event loop of its own. Raises BackupError: the target is not empty; the archive is of a later
    version, cut off, changed or hostile.
    """
    with Archive(source) as archive:
        _must_be_known(archive)
        _must_stay_clear(archive, settings)
        _must_have_room(archive, settings)
        progress("checking the archive")
        archive.verify()
        try:
            with claimed(settings.async_database_url):
                return asyncio.run(_put_back(archive, settings, progress))
        except DatabaseUnusable as error:
            raise BackupError(sentence_of(error.reason)) from error
        except SpoolTaken as error:
            raise BackupError(f"a server uses {settings.spool_path}: stop it first") from error
        except SpoolForeign as error:
            raise BackupError(sentence_of(error.reason)) from error
        except DBAPIError as error:
            raise BackupError(f"the database refuses what the archive holds: {why(error)}") from error
        except (SQLAlchemyError, OSError, SpoolFull) as error:
            raise BackupError(f"the archive could not be restored: {' '.join(str(error).split())}") from error


def _must_be_known(archive: Archive) -> None:
    if archive.manifest.schema_revision not in known_revisions():
        by, revision = archive.manifest.software[:40], archive.manifest.schema_revision[:40]
        raise BackupError(
            f"the archive was made by a later Crossfix ({by}, schema {revision}): update this one, then restore"
        )


def _must_stay_clear(archive: Archive, settings: Settings) -> None:
    """Of the database, which may lie in the data directory under any name: nothing of an archive is opened as one."""
    for member in archive.manifest.members:
        if (place := _place(member)) is not None and is_database(settings, settings.data_dir / place):
            raise BackupError(
                f"the archive holds a part named {member.name[:80]!r}, where this server keeps its database: "
                "name another database (--database)"
            )


def _must_have_room(archive: Archive, settings: Settings) -> None:
    try:
        settings.data_dir.mkdir(parents=True, exist_ok=True)
        free = shutil.disk_usage(settings.data_dir).free - settings.disk_low_bytes
    except OSError as error:
        raise BackupError(f"nothing can be written in {settings.data_dir}: {error.strerror or error}") from error
    tables = sum(member.size_bytes for member in archive.manifest.members if member.rows is not None)
    needed = archive.manifest.size_bytes + tables  # the database writes its rows twice: its log, then its file
    if needed > free:
        raise BackupError(
            f"the archive unpacks to {archive.manifest.size_bytes:,} bytes and needs {needed:,}; "
            f"{max(free, 0):,} are free in {settings.data_dir}"
        )


async def _put_back(archive: Archive, settings: Settings, progress: Callable[[str], None]) -> Restored:
    url, members = settings.async_database_url, archive.manifest.members
    _must_hold_no_files(settings)
    engine = engine_for_once(url, ANSWERS_S)
    try:
        async with engine.execution_options(write=True).begin() as connection:
            there = await connection.run_sync(_must_hold_no_rows)
            if there not in (None, archive.manifest.schema_revision):
                await connection.run_sync(_drop_empty_tables)
        await migrate(url, revision=archive.manifest.schema_revision)
        with _spool_cleared_on_error(settings), _unpacked(archive, settings) as keep:
            async with engine.execution_options(write=True).begin() as connection:
                await _write_tables(connection, archive, progress)
                await _bring_forward(connection)
                progress("files")
                pattern = keep()  # before the rows are committed: they are what a server finds
                _write_spool(archive, settings)
    finally:
        await dispose(engine)
    counted = {member.name: member.rows or 0 for member in members}
    files = sum(member.name.startswith((FILES, PATTERN)) for member in members)
    return Restored(counted.get(f"{DATABASE}missions.jsonl", 0), archive.manifest.rows, files, pattern)


def _must_hold_no_files(settings: Settings) -> None:
    found = [
        path.relative_to(settings.data_dir).as_posix()
        for path in sorted(settings.data_dir.rglob("*"))
        if path.is_file() and not is_database(settings, path)
    ]
    foreign = [name for name in found if not of_the_machine(name) and name != AUDIT_FILE]
    if foreign:
        raise BackupError(
            f"{settings.data_dir} is not empty (it holds {foreign[0]}): restore into an empty data directory "
            "(--data-dir)"
        )
    if entries_beside(settings.spool_path):
        raise BackupError(
            f"facts wait for the database in {settings.spool_path}: start the server once, or move it away"
        )


def _must_hold_no_rows(connection: Connection) -> str | None:
    """The revision of its schema, None for a database without tables. Raises BackupError when a table holds a row, or
    is none of ours."""
    tables = reflected(connection).sorted_tables
    for table in tables:
        if connection.execute(select(table).limit(1)).first() is not None:
            raise BackupError(
                f"the database is not empty (table {table.name} holds rows): restore into a new one (--database)"
            )
    revision = revision_of(connection)
    if tables and revision is None:
        raise BackupError(
            f"the database holds tables of something else ({tables[0].name}): restore into a new one (--database)"
        )
    return revision


def _drop_empty_tables(connection: Connection) -> None:
    """Of another schema than the archive's, whose own is made instead."""
    ours = [table for table in reversed(reflected(connection).sorted_tables) if table.name in metadata.tables]
    for table in ours:
        table.drop(connection)
    connection.execute(text(f"DROP TABLE {VERSION_TABLE}"))


async def _bring_forward(connection: AsyncConnection) -> None:
    """The rows of an older archive. In their transaction: where that fails, nothing of them is left."""
    try:
        await connection.run_sync(bring_forward)
    except (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError) as error:
        raise BackupError(
            f"what the archive holds cannot be brought to today's schema ({type(error).__name__}: {why(error)}): "
            "it was not made by Crossfix, or is damaged"
        ) from error


async def _write_tables(connection: AsyncConnection, archive: Archive, progress: Callable[[str], None]) -> None:
    reflection = await connection.run_sync(reflected)
    if archive.manifest.schema_revision < PACKED_SINCE:  # the migrations on the way read plain text
        reflection.tables["events"].c.body.type = Text()
    listed = {
        member.name.removeprefix(DATABASE).removesuffix(".jsonl"): member
        for member in archive.manifest.members
        if member.name.startswith(DATABASE)
    }
    unknown = sorted(set(listed) - set(reflection.tables))
    if unknown:
        raise BackupError(f"the archive holds a table {unknown[0][:60]!r} that its schema does not have")
    for table in reflection.sorted_tables:
        if member := listed.get(table.name):
            progress(table.name)
            with closing(archive.lines(member)) as lines:
                rows = await write_lines(connection, table, lines)
            if rows != member.rows:
                raise BackupError(f"table {table.name} has {rows} rows in the archive, and {member.rows} by its list")


@contextmanager
def _unpacked(archive: Archive, settings: Settings) -> Generator[Callable[[], Path | None]]:
    """The files in a folder beside their places; the function that is given moves them there, and returns where the
    antenna pattern went. Whatever fails afterwards, moved files are taken away again."""
    root = settings.data_dir
    folder = Path(tempfile.mkdtemp(prefix=".restoring-", dir=root))
    moved: list[Path] = []
    places = {member: _place(member) for member in archive.manifest.members if _place(member)}
    audit, aside = root / AUDIT_FILE, root / _free(AUDIT_BEFORE, places.values())

    def keep() -> Path | None:
        pattern = None
        if AUDIT_FILE in places.values() and audit.exists():
            audit.rename(aside)
        for member, place in places.items():
            target = root / str(place)
            target.parent.mkdir(parents=True, exist_ok=True)
            if target.exists():
                raise BackupError(f"{target} is there already, and stays as it is")
            os.replace(folder / str(place), target)
            moved.append(target)
            pattern = target if member.name.startswith(PATTERN) else pattern
        return pattern

    try:
        for member, place in places.items():
            path = folder / str(place)
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("xb") as file:
                if str(place).endswith((AUDIT_FILE, AUDIT_BEFORE)):
                    os.fchmod(file.fileno(), 0o600)  # as the server makes it
                for block in archive.blocks(member):
                    file.write(block)
                file.flush()
                os.fsync(file.fileno())
        yield keep
    except BaseException:
        for path in moved:
            path.unlink(missing_ok=True)
        if aside.exists() and not audit.exists():
            aside.rename(audit)
        raise
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _free(name: str, taken: Collection[str | None]) -> str:
    """Of an archive that was made after a restore before."""
    return name if name not in taken else _free(f"another-{name}", taken)


def _place(member: Member) -> str | None:
    """Inside the data directory; None for what is no file there. Names were checked when the archive was opened."""
    if member.name.startswith(PATTERN):
        return f"{PATTERNS}/{member.name.removeprefix(PATTERN)}"
    return member.name.removeprefix(FILES) if member.name.startswith(FILES) else None


@contextmanager
def _spool_cleared_on_error(settings: Settings) -> Generator[None]:
    """The next start must not meet facts of missions that did not come back."""
    try:
        yield
    except BaseException:
        if settings.spool_path.exists():
            with closing(Spool(settings.spool_path, 0)) as spool:
                spool.clear()
        raise


def _write_spool(archive: Archive, settings: Settings) -> None:
    """The next start stores what had waited; what had been stored meanwhile is known by its number."""
    waiting = [line for member in archive.manifest.members if member.name == SPOOL for line in archive.lines(member)]
    if not waiting:
        return
    with closing(Spool(settings.spool_path, settings.spool_reserve_bytes)) as spool:
        spool.clear()
        for payload in waiting:
            spool.append(payload)
