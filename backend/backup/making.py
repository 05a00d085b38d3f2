"""An archive of a server's data, while it flies: one read of the database as it stood at one moment, and the files.

The flight is not disturbed: a reader blocks no writer, neither in SQLite's write-ahead log nor in PostgreSQL.
"""

from __future__ import annotations

import asyncio
import os
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from sqlalchemy import make_url
from sqlalchemy.exc import DBAPIError, SQLAlchemyError
from sqlalchemy.ext.asyncio import AsyncEngine

from backend.backup.archive import BLOCK_BYTES, ArchiveWriter
from backend.backup.manifest import DATABASE, FILES, FORMAT, PATTERN, SPOOL, BackupError, Manifest, of_the_machine
from backend.backup.rows import lines_of, reflected, revision_of
from backend.settings import Settings
from backend.store.engine import database_missing, dispose, engine_for_once
from backend.store.reading import why
from backend.store.spool import SpoolForeign, entries_beside
from backend.version import VERSION
from planner.reason import sentence_of

ANSWERS_S = 30.0


@dataclass(frozen=True, slots=True)
class Made:
    """gone: files that were deleted while the archive was made."""

    path: Path
    manifest: Manifest
    gone: tuple[str, ...]


def make_backup(
    settings: Settings, target: Path, progress: Callable[[str], None] = lambda _: None, now: datetime | None = None
) -> Made:
    """The archive at `target`, complete and on the disk, or no file of that name. told: what is being saved now.

    Blocking, with an event loop of its own. Raises BackupError.
    """
    if target.exists():
        raise BackupError(f"{target} is there already: choose another name, or move it away")
    _must_be_there(settings)
    try:
        descriptor, name = tempfile.mkstemp(prefix=f".{target.name}-", suffix=".part", dir=target.parent)
    except OSError as error:
        raise BackupError(f"nothing can be written in {target.parent}: {error.strerror or error}") from error
    part = Path(name)
    try:
        with os.fdopen(descriptor, "w+b") as file:
            with ArchiveWriter(file) as archive:
                manifest, gone = asyncio.run(_write(settings, archive, progress, now or datetime.now(UTC)))
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, target)
    except SpoolForeign as error:
        raise BackupError(sentence_of(error.reason)) from error
    except DBAPIError as error:
        raise BackupError(f"the database did not answer to the end ({why(error)}): try again") from error
    except (SQLAlchemyError, OSError) as error:
        raise BackupError(f"the archive could not be made: {' '.join(str(error).split())}") from error
    finally:
        part.unlink(missing_ok=True)
    return Made(target, manifest, tuple(gone))


def _must_be_there(settings: Settings) -> None:
    missing = database_missing(settings.async_database_url)
    if missing is not None:
        raise BackupError(missing)


async def _write(
    settings: Settings, archive: ArchiveWriter, progress: Callable[[str], None], at: datetime
) -> tuple[Manifest, list[str]]:
    # the spool first: what the server stores meanwhile is then in the database, and nothing is in neither
    waiting = entries_beside(settings.spool_path)
    engine = engine_for_once(settings.async_database_url, ANSWERS_S)
    try:
        revision = await _write_tables(engine, archive, progress)
    finally:
        await dispose(engine)
    with archive.part(SPOOL) as part:
        for payload in waiting:
            part.write(payload + b"\n")
    gone: list[str] = []
    progress("files")
    for name, path in _files(settings):
        try:
            _copy(archive, name, path)
        except FileNotFoundError:
            gone.append(name)
    kind = "sqlite" if make_url(settings.async_database_url).get_backend_name() == "sqlite" else "postgresql"
    manifest = Manifest(
        format=FORMAT,
        software=VERSION,
        made_at_utc=at,
        database=kind,
        schema_revision=revision,
        members=tuple(archive.members),
    )
    archive.finish(manifest)
    return manifest, gone


async def _write_tables(engine: AsyncEngine, archive: ArchiveWriter, progress: Callable[[str], None]) -> str:
    """All tables as they stood at one moment; the schema's revision."""
    if engine.dialect.name == "postgresql":
        engine = engine.execution_options(isolation_level="REPEATABLE READ", postgresql_readonly=True)
    async with engine.connect() as connection, connection.begin():
        revision = await connection.run_sync(revision_of)
        if revision is None:
            raise BackupError("the database holds no schema of Crossfix: start the server on it once")
        metadata = await connection.run_sync(reflected)
        for table in metadata.sorted_tables:
            progress(table.name)
            rows = -1
            with archive.part(f"{DATABASE}{table.name}.jsonl") as part:
                async for line in lines_of(connection, table):
                    part.write(line)
                    rows += 1
            archive.counted(rows)
    return revision


def _files(settings: Settings) -> Iterator[tuple[str, Path]]:
    """(name in the archive, path): plain files of the data directory, and the antenna pattern that is used."""
    root = settings.data_dir
    for folder, _, names in os.walk(root):
        for file_name in sorted(names):
            path = Path(folder) / file_name
            relative = path.relative_to(root).as_posix()
            if (
                not of_the_machine(relative)
                and path.is_file()
                and not path.is_symlink()
                and not is_database(settings, path)
            ):
                yield FILES + relative, path
    if settings.antenna_pattern is not None:
        yield PATTERN + settings.antenna_pattern.name, settings.antenna_pattern


def is_database(settings: Settings, path: Path) -> bool:
    """An SQLite file under a name of its own, or what SQLite keeps beside it."""
    url = make_url(settings.async_database_url)
    if url.get_backend_name() != "sqlite":
        return False
    database = Path(url.database or "").resolve()
    return path.resolve().parent == database.parent and path.name.lower().startswith(database.name.lower())


def _copy(archive: ArchiveWriter, name: str, path: Path) -> None:
    with path.open("rb") as source, archive.part(name) as part:
        while block := source.read(BLOCK_BYTES):
            part.write(block)
