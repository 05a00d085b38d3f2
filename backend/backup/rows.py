"""The rows of a database, a line of JSON each, whichever database they came from.

An archive of rows goes back into SQLite and PostgreSQL alike, and nothing of it is ever opened as a database.
"""

from __future__ import annotations

import base64
import json
import logging
from collections.abc import AsyncGenerator, Iterable, Iterator, Sequence
from datetime import date, datetime
from typing import Any, Literal, cast

from sqlalchemy import Connection, Dialect, MetaData, Table, insert, inspect, select, text, types
from sqlalchemy.ext.asyncio import AsyncConnection

from backend.backup.manifest import BackupError
from backend.store.packed import MARK, PackedText

log = logging.getLogger("crossfix.backup")

VERSION_TABLE = "alembic_version"
READ_AT_ONCE = 200
WRITE_AT_ONCE, WRITE_BYTES_AT_ONCE = 500, 4 * 2**20
LONGEST_LINE = 256 * 2**20
"""One row; the longest honest one is a sweep of some hundred kilobytes."""

Kind = Literal["bytes", "time", "plain"]


class SavedText(PackedText):
    """What is damaged is saved as nothing: the rest of the database is worth a backup all the same."""

    cache_ok = True

    def process_result_value(self, value: Any | None, dialect: Dialect) -> str | None:
        """Nothing of what cannot be unpacked."""
        try:
            return super().process_result_value(value, dialect)
        except ValueError:
            return ""


def kinds_of(table: Table, names: Sequence[str]) -> list[Kind]:
    """How the values of these columns are written in JSON."""
    return [_kind_of(table.c[name].type) for name in names]


def _kind_of(column_type: types.TypeEngine[Any]) -> Kind:
    if isinstance(column_type, types.LargeBinary | types.BINARY | types.VARBINARY):
        return "bytes"
    return "time" if isinstance(column_type, types.DateTime | types.Date) else "plain"


def reflected(connection: Connection) -> MetaData:
    """The tables that are there, without the one that counts migrations; each before those that refer to it."""
    metadata = MetaData()
    names = [name for name in inspect(connection).get_table_names() if name != VERSION_TABLE]
    metadata.reflect(connection, only=names)
    if "events" in metadata.tables:
        metadata.tables["events"].c.body.type = SavedText()
    return metadata


def revision_of(connection: Connection) -> str | None:
    """The schema's revision; None in a database without one."""
    if not inspect(connection).has_table(VERSION_TABLE):
        return None
    return connection.execute(text(f"SELECT version_num FROM {VERSION_TABLE}")).scalar()


async def lines_of(connection: AsyncConnection, table: Table) -> AsyncGenerator[bytes]:
    """The columns' names, then the rows in the order of the primary key."""
    yield _line([column.name for column in table.c])
    kinds = kinds_of(table, [column.name for column in table.c])
    query = select(table).order_by(*table.primary_key.columns).execution_options(yield_per=READ_AT_ONCE)
    async with connection.stream(query) as result:
        async for row in result:
            if table.name == "events" and not row.body:
                log.error("event %d of mission %s is damaged and saved as nothing", row.seq, row.mission_id)
            yield _line([_said(value, kind) for value, kind in zip(row, kinds, strict=True)])


def _line(values: Sequence[Any]) -> bytes:
    return json.dumps(values, separators=(",", ":")).encode() + b"\n"


def _said(value: Any, kind: Kind) -> Any:
    if value is None or kind == "plain":
        return value
    return base64.b64encode(value).decode() if kind == "bytes" else value.isoformat()


async def write_lines(connection: AsyncConnection, table: Table, lines: Iterable[bytes]) -> int:
    """Into an empty table; returns how many rows. Raises BackupError for what is no row of this table."""
    written = 0
    for batch in _batches(table, iter(lines)):
        try:
            await connection.execute(insert(table), batch)
        except (
            ValueError,
            TypeError,
            ArithmeticError,
            RecursionError,
        ) as error:
            raise BackupError(f"a value of table {table.name} cannot be stored: {error}") from error
        written += len(batch)
    return written


def _batches(table: Table, lines: Iterator[bytes]) -> Iterator[list[dict[str, Any]]]:
    names = _parsed(table, next(lines, b"[]"))
    if set(names) - {column.name for column in table.c} or len(set(names)) < len(names) or not names:
        raise BackupError(f"the archive's table {table.name} has other columns than the schema that it names")
    kinds = kinds_of(table, names)
    batch: list[dict[str, Any]] = []
    size = 0
    for line in lines:
        values = _parsed(table, line)
        if len(values) != len(names):
            raise BackupError(f"a row of table {table.name} has {len(values)} values instead of {len(names)}")
        batch.append({n: _read(table, v, k) for n, v, k in zip(names, values, kinds, strict=True)})
        if str(batch[-1].get("body", "")).startswith(MARK):
            raise BackupError(f"a row of table {table.name} is packed, which no archive of ours is")
        size += len(line)
        if len(batch) >= WRITE_AT_ONCE or size >= WRITE_BYTES_AT_ONCE:
            yield batch
            batch, size = [], 0
    if batch:
        yield batch


def _parsed(table: Table, line: bytes) -> list[Any]:
    try:
        values: Any = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise BackupError(f"a row of table {table.name} is not JSON: the archive was not made by Crossfix") from error
    if not isinstance(values, list):
        raise BackupError(f"a row of table {table.name} is no list: the archive was not made by Crossfix")
    return cast(list[Any], values)


def _read(table: Table, value: Any, kind: Kind) -> Any:
    if value is None or kind == "plain":
        return value
    try:
        return base64.b64decode(value, validate=True) if kind == "bytes" else _moment(table, value)
    except (ValueError, TypeError) as error:
        raise BackupError(f"a value of table {table.name} cannot be read: {error}") from error


def _moment(_table: Table, value: str) -> datetime | date:
    return datetime.fromisoformat(value) if "T" in value else date.fromisoformat(value)
