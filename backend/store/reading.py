"""What the database holds, read back. Every question is bounded in time."""

from __future__ import annotations

import asyncio
import logging
import sqlite3
from collections.abc import Collection, Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from sqlalchemy import ColumnElement, Executable, exc, func, or_, select, text
from sqlalchemy.ext.asyncio import AsyncEngine

from backend.beside import MANY, beside
from backend.events import FORM, Recorded
from backend.ports import JournalDamaged, JournalUnavailable, Kept, TrackPoint
from backend.reasons.storage import DatabaseSilent, DatabaseTaken, DiskBusy, MachineBusy, MissionDamaged
from backend.store.digest import MissionDigest, from_columns
from backend.store.entries import (
    ROW,
    EventRow,
    EventsEntry,
    SweepEntry,
    imported_before,
    sweep_columns,
    to_records,
    to_texts,
)
from backend.store.handed_over import HandedOver
from backend.store.paths import unpacked_path
from backend.store.patience import CrowdedError, StarvedError, patience
from backend.store.tables import events, missions, paths, sweeps, tracks
from backend.store.upgrade import FIRST_FORM, OF_A_SWEEP, Imports, kinds_of_old

log = logging.getLogger("crossfix.store")

GOES_ON = 5.0
"""Times as long as it is waited for: PostgreSQL does not notice that whoever asked has gone, and ends a question that
is given up after this. By far longer than the wait, which does not count what this program itself stood still."""


@dataclass(frozen=True, slots=True)
class PlaceInList:
    """Of a mission in the list, the last drafted first."""

    drafted_at_us: int
    mission_id: str


@dataclass(frozen=True, slots=True)
class Wanted:
    """Which missions. named: a part of name, tags or notes; emitter: of an emitter's name, id or frequency (MHz); box:
    west, south, east, north, degrees: the area meets it, and a box whose west lies east of its east reaches through the
    antimeridian; since, until: drafted, UTC us, until excluded. deleted: those
    that wait to be gone, instead of all others. checked: somebody told where an emitter was. "" and None: any."""

    named: str = ""
    emitter: str = ""
    vehicle: str = ""
    outcome: str = ""
    box: tuple[float, float, float, float] | None = None
    since_us: int | None = None
    until_us: int | None = None
    deleted: bool = False
    checked: bool = False


ANY = Wanted()


def _asked(wanted: Wanted) -> Iterator[ColumnElement[bool]]:
    columns = missions.c
    yield columns.deleted_at_us.is_not(None) if wanted.deleted else columns.deleted_at_us.is_(None)
    if wanted.named:
        yield or_(*(c.icontains(wanted.named, autoescape=True) for c in (columns.name, columns.tags, columns.notes)))
    if wanted.emitter:
        yield columns.sought.contains(wanted.emitter.lower(), autoescape=True)
    if wanted.vehicle:
        yield columns.vehicles.contains(wanted.vehicle.lower(), autoescape=True)
    if wanted.outcome:
        yield columns.outcome == wanted.outcome
    if wanted.box is not None:
        west, south, east, north = wanted.box
        yield (columns.south <= north) & (columns.north >= south)
        if abs(east - west) < 360.0:
            west, east = _on_the_globe(west), _on_the_globe(east)
            begun, ends, whole = columns.west <= east, columns.east >= west, columns.west <= columns.east
            if west <= east:
                yield (begun & ends) | (~whole & (begun | ends))
            else:  # through the antimeridian, as an area may lie
                yield begun | ends | ~whole
    if wanted.since_us is not None:
        yield columns.drafted_at_us >= wanted.since_us
    if wanted.until_us is not None:
        yield columns.drafted_at_us < wanted.until_us
    if wanted.checked:
        yield columns.truths > 0


def _on_the_globe(lon: float) -> float:
    """In [-180, 180]; 180 stays where it is, on the eastern side."""
    return lon if abs(lon) <= 180.0 else (lon + 180.0) % 360.0 - 180.0


class StoredFacts:
    """All methods raise JournalUnavailable when the database does not answer in time; those that read what a mission
    did raise JournalDamaged."""

    def __init__(self, engine: AsyncEngine, timeout_s: float) -> None:
        self._engine = engine
        self._timeout_s = timeout_s
        self._limit: Executable | None = None
        if engine.dialect.name == "postgresql":
            self._limit = text(f"SET LOCAL statement_timeout = {round(1e3 * GOES_ON * timeout_s)}")

    async def read(
        self, mission_id: str, after: int = 0, kinds: Collection[str] | None = None, most: int | None = None
    ) -> list[Recorded]:
        """Facts of today's form, in order; older ones are upgraded. kinds, most: None for all."""
        with _whole(mission_id):
            rows = await self._rows(mission_id, after, kinds, most)
            return await beside(len(rows), to_records, mission_id, rows, await self._imports(mission_id, rows))

    async def read_texts(self, mission_id: str, after: int = 0, most: int | None = None) -> list[str]:
        """What `read` gives, each as the wire tells it."""
        with _whole(mission_id):
            rows = await self._rows(mission_id, after, None, most)
            told_anew = sum(row.form != FORM for row in rows)
            return await beside(told_anew, to_texts, mission_id, rows, await self._imports(mission_id, rows))

    async def hand_over(self, mission_id: str, piece: int, most: int | None) -> HandedOver:
        """The first `most` of its facts (None: all), `piece` at a time."""
        pieces, imports, after = list[bytes](), dict[str, str](), 0
        with _whole(mission_id):
            while most is None or after < most:
                rows = await self._rows(mission_id, after, None, piece if most is None else min(piece, most - after))
                if not rows:
                    break
                imports |= await self._imports(mission_id, rows)
                pieces.append(await asyncio.to_thread(EventsEntry(mission_id, tuple(rows)).encode))
                after = rows[-1].seq
        return HandedOver(tuple(pieces), imports)

    async def _rows(
        self, mission_id: str, after: int, kinds: Collection[str] | None, most: int | None
    ) -> list[EventRow]:
        query = select(*ROW).where(events.c.mission_id == mission_id, events.c.seq > after).order_by(events.c.seq)
        query = query.limit(most)
        if kinds is not None:
            query = query.where(events.c.kind.in_(kinds_of_old(kinds)))
        rows = await self._fetch(query)
        return await beside(len(rows), lambda: [EventRow(*row) for row in rows])

    async def _imports(self, mission_id: str, rows: Sequence[EventRow]) -> Imports:
        """What the mission says of imported sweeps, asked for where a row of form 1 needs it."""
        if not any(row.form == FIRST_FORM and row.kind in OF_A_SWEEP for row in rows):
            return {}
        told = select(*ROW).where(events.c.mission_id == mission_id, events.c.kind == "recording_imported")
        return imported_before(EventRow(*row) for row in await self._fetch(told))

    async def mission(self, mission_id: str) -> MissionDigest | None:
        """None for an unknown mission."""
        rows = await self._fetch(select(missions).where(missions.c.mission_id == mission_id))
        return from_columns(rows[0]._mapping) if rows else None

    async def missions(self, most: int | None = None) -> list[MissionDigest]:
        """The last drafted first, the deleted ones among them; most None: all."""
        newest = select(missions).order_by(missions.c.drafted_at_us.desc(), missions.c.mission_id).limit(most)
        return [from_columns(row._mapping) for row in await self._fetch(newest)]

    async def page(self, most: int, before: PlaceInList | None, wanted: Wanted) -> list[MissionDigest]:
        """The next missions of the same list. before: the last one known, None for the first page."""
        query = (
            select(missions)
            .where(*_asked(wanted))
            .order_by(missions.c.drafted_at_us.desc(), missions.c.mission_id)
            .limit(most)
        )
        if before is not None:
            at, later = missions.c.drafted_at_us, missions.c.mission_id > before.mission_id
            query = query.where((at < before.drafted_at_us) | ((at == before.drafted_at_us) & later))
        return [from_columns(row._mapping) for row in await self._fetch(query)]

    async def unfinished(self) -> list[MissionDigest]:
        """Started, and not ended or with a craft still in the air."""
        going_on = missions.c.ended_at_us.is_(None) | missions.c.flying
        query = select(missions).where(missions.c.started_at_us.is_not(None) & going_on)
        return [from_columns(row._mapping) for row in await self._fetch(query)]

    async def sweep(self, mission_id: str, sweep_id: str) -> SweepEntry | None:
        """None for an unknown sweep."""
        columns = [sweeps.c[name] for name in sweep_columns()]
        here = (sweeps.c.mission_id == mission_id) & (sweeps.c.sweep_id == sweep_id)
        rows = await self._fetch(select(*columns).where(here))
        return SweepEntry(**rows[0]._mapping) if rows else None

    async def sweeps(self, mission_id: str) -> list[SweepEntry]:
        """All of a mission, by id."""
        columns = [sweeps.c[name] for name in sweep_columns()]
        query = select(*columns).where(sweeps.c.mission_id == mission_id).order_by(sweeps.c.sweep_id)
        return [SweepEntry(**row._mapping) for row in await self._fetch(query)]

    async def imported_sweeps(self) -> Kept:
        """The raw sweeps that came with recordings."""
        size = func.coalesce(func.sum(func.length(sweeps.c.samples)), 0)
        rows = await self._fetch(select(func.count(), size).where(sweeps.c.craft_id.is_(None)))
        return Kept(int(rows[0][0]), int(rows[0][1]))

    async def tracks(self, mission_id: str) -> dict[str, list[TrackPoint]]:
        """By craft, in time order. The rows are read first: what is packed between the two questions comes twice, and
        counts once."""
        columns = [column for column in tracks.c if column.name != "mission_id"]
        rows = await self._fetch(select(*columns).where(tracks.c.mission_id == mission_id))
        pieces = await self._fetch(select(paths.c.craft_id, paths.c.points).where(paths.c.mission_id == mission_id))
        with _whole(mission_id):
            return await asyncio.to_thread(_in_time_order, rows, pieces)

    async def _fetch(self, query: Executable) -> list[Any]:
        try:
            async with patience(self._timeout_s), self._engine.connect() as connection:
                if self._limit is not None:
                    await connection.execute(self._limit)
                found = await connection.execute(query)
        except (exc.DBAPIError, exc.TimeoutError, OSError) as error:
            raise unavailable(error, self._engine) from error
        # All rows have come from the database by now; to unpack the texts of many takes long.
        rows = list[Any](found.fetchmany(MANY))
        return rows if len(rows) < MANY else rows + list(await asyncio.to_thread(found.fetchall))


@contextmanager
def _whole(mission_id: str) -> Generator[None]:
    """Raises JournalDamaged for what cannot be unpacked, or is no fact."""
    try:
        yield
    except ValueError as error:
        raise damaged(mission_id, error) from error


def damaged(mission_id: str, error: ValueError) -> JournalDamaged:
    """The error for those who read the mission. It is logged, too."""
    log.error("mission %s: what is stored of it cannot be read: %s", mission_id, error)
    return JournalDamaged(MissionDamaged(mission_id, why(error)))


def _in_time_order(rows: Iterable[Any], pieces: Iterable[Any]) -> dict[str, list[TrackPoint]]:
    found: dict[str, dict[int, TrackPoint]] = {}
    for craft_id, at_us, *values in rows:
        found.setdefault(craft_id, {})[at_us] = TrackPoint(at_us / 1e6, *values)
    for craft_id, piece in pieces:
        told = {round(point.at_s * 1e6): point for point in unpacked_path(piece)}
        found[craft_id] = told | found.get(craft_id, {})
    return {craft_id: [by_time[at_us] for at_us in sorted(by_time)] for craft_id, by_time in sorted(found.items())}


Unanswered = DatabaseSilent | DatabaseTaken | DiskBusy | MachineBusy


def unanswered(error: BaseException, engine: AsyncEngine) -> Unanswered:
    """What a driver's error says of its database: only one that is asked over a socket can be away."""
    if isinstance(error, StarvedError):
        return MachineBusy()
    if engine.dialect.name == "sqlite":
        orig = error.orig if isinstance(error, exc.DBAPIError) else None
        if isinstance(orig, sqlite3.Error) and getattr(orig, "sqlite_errorcode", 0) & 0xFF == sqlite3.SQLITE_BUSY:
            return DatabaseTaken()
        if isinstance(error, TimeoutError):
            return MachineBusy() if isinstance(error, CrowdedError) else DiskBusy()
    return DatabaseSilent(why(error))


def unavailable(error: BaseException, engine: AsyncEngine) -> JournalUnavailable:
    """The driver's error, as readers of the journal know it."""
    return JournalUnavailable(unanswered(error, engine))


def refuses(error: BaseException) -> bool:
    """Did the database answer that it will never take this? SQLAlchemy names a value that PostgreSQL cannot hold
    (SQLSTATE class 22) by the base class only, when asyncpg says so."""
    if isinstance(error, exc.IntegrityError | exc.DataError):
        return True
    return isinstance(error, exc.DBAPIError) and str(getattr(error.orig, "sqlstate", None) or "").startswith("22")


def why(error: BaseException) -> str:
    """One line of what a driver says, without its full stop."""
    if isinstance(error, TimeoutError | exc.TimeoutError):
        return "no answer in time"
    cause = error.orig if isinstance(error, exc.DBAPIError) and error.orig else error
    return str(cause).splitlines()[0].rstrip(".") if str(cause) else type(cause).__name__
