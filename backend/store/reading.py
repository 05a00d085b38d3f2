"""What the database holds, read back. Every question is bounded in time."""

from __future__ import annotations

import asyncio
from collections.abc import Collection
from typing import Any

from sqlalchemy import Executable, exc, select
from sqlalchemy.ext.asyncio import AsyncEngine

from backend.events import Recorded
from backend.mission.ports import JournalUnavailable, TrackPoint
from backend.store.digest import MissionDigest
from backend.store.entries import EventRow, SweepEntry, sweep_columns, to_record
from backend.store.tables import events, missions, sweeps, track


class StoredFacts:
    """All methods raise JournalUnavailable when the database does not answer in time."""

    def __init__(self, engine: AsyncEngine, timeout_s: float) -> None:
        self._engine = engine
        self._timeout_s = timeout_s

    async def read(self, mission_id: str, after: int = 0, kinds: Collection[str] | None = None) -> list[Recorded]:
        query = (
            select(events.c.seq, events.c.at_us, events.c.kind, events.c.body)
            .where(events.c.mission_id == mission_id, events.c.seq > after)
            .order_by(events.c.seq)
        )
        if kinds is not None:
            query = query.where(events.c.kind.in_(list(kinds)))
        return [to_record(mission_id, EventRow(*row)) for row in await self._fetch(query)]

    async def mission(self, mission_id: str) -> MissionDigest | None:
        rows = await self._fetch(select(missions).where(missions.c.mission_id == mission_id))
        return MissionDigest(**rows[0]._mapping) if rows else None

    async def missions(self) -> list[MissionDigest]:
        rows = await self._fetch(select(missions).order_by(missions.c.drafted_at_us.desc(), missions.c.mission_id))
        return [MissionDigest(**row._mapping) for row in rows]

    async def unfinished(self) -> list[MissionDigest]:
        started = missions.c.started_at_us.is_not(None) & missions.c.ended_at_us.is_(None)
        return [MissionDigest(**row._mapping) for row in await self._fetch(select(missions).where(started))]

    async def sweep(self, mission_id: str, sweep_id: str) -> SweepEntry | None:
        columns = [sweeps.c[name] for name in sweep_columns()]
        here = (sweeps.c.mission_id == mission_id) & (sweeps.c.sweep_id == sweep_id)
        rows = await self._fetch(select(*columns).where(here))
        return SweepEntry(**rows[0]._mapping) if rows else None

    async def track(self, mission_id: str) -> list[TrackPoint]:
        columns = [column for column in track.c if column.name != "mission_id"]
        rows = await self._fetch(select(*columns).where(track.c.mission_id == mission_id).order_by(track.c.at_us))
        return [TrackPoint(row[0] / 1e6, *row[1:]) for row in rows]

    async def _fetch(self, query: Executable) -> list[Any]:
        try:
            async with asyncio.timeout(self._timeout_s), self._engine.connect() as connection:
                return list(await connection.execute(query))
        except (exc.DBAPIError, exc.TimeoutError, OSError) as error:
            raise JournalUnavailable(f"The database does not answer: {why(error)}.") from error


def why(error: BaseException) -> str:
    """One line of what a driver says."""
    if isinstance(error, TimeoutError | exc.TimeoutError):
        return "no answer in time"
    cause = error.orig if isinstance(error, exc.DBAPIError) and error.orig else error
    return str(cause).splitlines()[0] if str(cause) else type(cause).__name__
