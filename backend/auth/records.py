"""People, sessions, invitations and tokens in the database. One server writes; it reads them once, when it starts."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any, TypeVar

from sqlalchemy import ColumnElement, Table, delete, insert, select, update
from sqlalchemy.exc import DBAPIError, IntegrityError
from sqlalchemy.exc import TimeoutError as NoneFree
from sqlalchemy.ext.asyncio import AsyncConnection, AsyncEngine

from backend.auth.registry import Invitation, MachineToken, Person, Session
from backend.ports import FactRefused
from backend.reasons.storage import FactUnfit
from backend.store import tables
from backend.store.engine import dispose
from backend.store.patience import patience
from backend.store.reading import refuses, unavailable, why

Row = Person | Session | Invitation | MachineToken
TABLES: dict[type[Any], tuple[Table, str]] = {
    Person: (tables.people, "person_id"),
    Session: (tables.sessions, "session_id"),
    Invitation: (tables.invitations, "invitation_id"),
    MachineToken: (tables.machine_tokens, "token_id"),
}
One = TypeVar("One", Person, Session, Invitation, MachineToken)


@dataclass(frozen=True, slots=True)
class Stored:
    """All there is."""

    people: Sequence[Person]
    sessions: Sequence[Session]
    invitations: Sequence[Invitation]
    tokens: Sequence[MachineToken]


class RowThere(FactRefused):
    """The database holds a row already that excludes this one."""


class Records:
    """Each call is one transaction. All raise JournalUnavailable when the database does not answer: then nothing is
    known about what they should change. FactRefused: the database can never hold it."""

    def __init__(self, engine: AsyncEngine, timeout_s: float) -> None:
        self._engine = engine.execution_options(write=True)
        self._timeout_s = timeout_s

    async def load(self, *, settled: bool = False) -> Stored:
        """Everything. settled: with whatever a transaction changes that is still about to be stored, which is waited
        for; SQLite lets nobody write beside it anyway."""

        async def read(connection: AsyncConnection) -> Stored:
            if settled and connection.dialect.name == "postgresql":
                await connection.exec_driver_sql(f"SET LOCAL lock_timeout = {round(1000 * self._timeout_s)}")
                await connection.exec_driver_sql("LOCK TABLE people, invitations IN SHARE MODE")
            return Stored(
                await _all(connection, Person),
                await _all(connection, Session),
                await _all(connection, Invitation),
                await _all(connection, MachineToken),
            )

        return await self._done(read)

    async def change(self, *, new: Sequence[Row] = (), now: Sequence[Row] = (), gone: Sequence[Row] = ()) -> None:
        """new: rows to insert. now: rows that are there, as they are now. gone: rows to remove. All or nothing.

        Raises RowThere."""

        async def write(connection: AsyncConnection) -> None:
            for row in new:
                await connection.execute(insert(TABLES[type(row)][0]).values(**asdict(row)))
            for row in now:
                table, same = _itself(row)
                await connection.execute(update(table).where(same).values(**asdict(row)))
            for row in gone:
                table, same = _itself(row)
                await connection.execute(delete(table).where(same))

        await self._done(write)

    async def close(self) -> None:
        """Its connections."""
        await dispose(self._engine)

    async def _done(self, work: Callable[[AsyncConnection], Awaitable[Any]]) -> Any:
        try:
            async with patience(self._timeout_s), self._engine.begin() as connection:
                return await work(connection)
        except (DBAPIError, NoneFree, OSError, TimeoutError) as error:
            if refuses(error):
                kind = RowThere if isinstance(error, IntegrityError) else FactRefused
                raise kind(FactUnfit("database", why(error))) from error
            raise unavailable(error, self._engine) from error


def _itself(row: Row) -> tuple[Table, ColumnElement[bool]]:
    table, key = TABLES[type(row)]
    return table, table.c[key] == getattr(row, key)


async def _all(connection: AsyncConnection, kind: type[One]) -> list[One]:
    rows = await connection.execute(select(TABLES[kind][0]))
    return [kind(**row) for row in rows.mappings()]
