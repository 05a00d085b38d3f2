"""How long raw sweeps and IQ are kept: of missions that are over, for as many days as the setting says; everything else
for ever, and the flown path packed as soon as the mission is over.

A bearing's power samples take some 16 kB, its facts 8 kB, and the path flown for it 20 kB in rows and 1 kB packed.
"""

from __future__ import annotations

import asyncio
import logging
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any

from sqlalchemy import ColumnElement, delete, func, select, true
from sqlalchemy.ext.asyncio import AsyncConnection, AsyncEngine

from backend.ports import TrackPoint
from backend.store.digest import to_us
from backend.store.iq_folder import IqFolder
from backend.store.paths import MOST_POINTS, packed_path
from backend.store.tables import events, missions, paths, sweeps, tracks

log = logging.getLogger("crossfix.store")

DELETED_DAYS = 30.0
"""So long a deleted mission can be restored."""
AT_ONCE = 50
"""Sweeps in one transaction: a flight that writes meanwhile waits for no more than that."""
PAUSE_S = 0.05
EVERY_S = 6 * 3600.0
FIRST_AFTER_S = 60.0


@dataclass(frozen=True, slots=True)
class Thinned:
    """size_bytes: of the samples as they are stored."""

    missions: int
    sweeps: int
    size_bytes: int


def _old(keep_days: float, now: datetime) -> ColumnElement[bool]:
    """Ended, every craft down, and all that longer ago than this. A mission that is open, or that never ended, is not
    among them."""
    before = to_us(now - timedelta(days=keep_days))
    return missions.c.ended_at_us.is_not(None) & (missions.c.ended_at_us < before) & ~missions.c.flying


async def old_sweeps(engine: AsyncEngine, keep_days: float, now: datetime) -> Thinned:
    """What the rule would take. Raises what the driver raises."""
    query = select(
        func.count(sweeps.c.mission_id.distinct()),
        func.count(),
        func.coalesce(func.sum(func.length(sweeps.c.samples)), 0),
    ).where(sweeps.c.mission_id == missions.c.mission_id, _old(keep_days, now))
    async with engine.connect() as connection:
        of, count, size = (await connection.execute(query)).one()
    return Thinned(int(of), int(count), int(size))


async def thin(engine: AsyncEngine, keep_days: float, now: datetime) -> Thinned:
    """Take the raw sweeps that are older than the rule, a few at a time. Raises what the driver raises."""
    found = await old_sweeps(engine, keep_days, now)
    writer = engine.execution_options(write=True)
    taken = 0
    while taken < found.sweeps:
        async with writer.begin() as connection:
            chosen = (
                select(sweeps.c.mission_id, sweeps.c.sweep_id)
                .where(sweeps.c.mission_id == missions.c.mission_id, _old(keep_days, now))
                .limit(AT_ONCE)
            )
            keys = [tuple(row) for row in await connection.execute(chosen)]
            for mission_id, sweep_id in keys:
                here = (sweeps.c.mission_id == mission_id) & (sweeps.c.sweep_id == sweep_id)
                await connection.execute(delete(sweeps).where(here))
        if not keys:
            break
        taken += len(keys)
        await asyncio.sleep(PAUSE_S)
    return found


async def pack_paths(engine: AsyncEngine, now: datetime) -> int:
    """The flown paths of missions that are over, out of their rows into pieces of an hour, one in a transaction. How
    many pieces. Raises what the driver raises."""
    query = select(tracks.c.mission_id, tracks.c.craft_id)
    query = query.where(tracks.c.mission_id == missions.c.mission_id, _old(0.0, now)).limit(1)
    packed = 0
    while True:
        async with engine.connect() as connection:
            found = (await connection.execute(query)).first()
        if found is None:
            return packed
        mission_id, craft_id = found
        async with engine.execution_options(write=True).begin() as connection:
            packed += await _pack_piece(connection, mission_id, craft_id)
        await asyncio.sleep(PAUSE_S)


async def _pack_piece(connection: AsyncConnection, mission_id: str, craft_id: str) -> int:
    """The first hour of what lies in rows. 0: it was a point that a piece holds already, written again."""
    columns = [column for column in tracks.c if column.name not in ("mission_id", "craft_id")]
    here = (tracks.c.mission_id == mission_id) & (tracks.c.craft_id == craft_id)
    query = select(*columns).where(here).order_by(tracks.c.at_us).limit(MOST_POINTS)
    rows: list[Any] = list(await connection.execute(query))
    if not rows:
        return 0
    first_us, last_us = rows[0][0], rows[-1][0]
    piece = {"mission_id": mission_id, "craft_id": craft_id, "at_us": first_us}
    same = [paths.c[name] == value for name, value in piece.items()]
    if (await connection.execute(select(paths.c.at_us).where(*same))).first() is not None:
        await connection.execute(delete(tracks).where(here & (tracks.c.at_us == first_us)))
        return 0
    small = await asyncio.to_thread(lambda: packed_path([TrackPoint(at_us / 1e6, *values) for at_us, *values in rows]))
    await connection.execute(paths.insert().values(piece | {"points": small}))
    await connection.execute(delete(tracks).where(here & (tracks.c.at_us <= last_us)))
    return 1


async def bury(engine: AsyncEngine, keep_days: float, now: datetime) -> int:
    """Missions that were deleted longer ago go for good, with all that is kept of them, one in a transaction. How many.
    Raises what the driver raises."""
    gone = (missions.c.deleted_at_us < to_us(now - timedelta(days=keep_days))) & ~missions.c.flying
    writer = engine.execution_options(write=True)
    taken = 0
    while True:
        async with writer.begin() as connection:
            mission_id = (await connection.execute(select(missions.c.mission_id).where(gone).limit(1))).scalar()
            if mission_id is None:
                return taken
            for table in (sweeps, tracks, paths, events, missions):
                await connection.execute(delete(table).where(table.c.mission_id == mission_id))
        taken += 1
        await asyncio.sleep(PAUSE_S)


async def thin_iq(engine: AsyncEngine, iq: IqFolder, keep_days: float | None, now: datetime) -> list[str]:
    """Take the IQ of missions that are older than the rule, and of those that are gone. Their ids. Raises what the
    driver raises. keep_days None: IQ of missions that are there is kept for ever."""
    kept = await asyncio.to_thread(iq.missions)
    staying: set[str] = set()
    stays = true() if keep_days is None else ~_old(keep_days, now)
    async with engine.connect() as connection:
        for at in range(0, len(kept), AT_ONCE):
            named = missions.c.mission_id.in_(kept[at : at + AT_ONCE])
            staying |= set(await connection.scalars(select(missions.c.mission_id).where(named & stays)))
    taken = [mission_id for mission_id in kept if mission_id not in staying]
    await asyncio.to_thread(iq.forget, taken)
    return taken


async def keep_thin(engine: AsyncEngine, keep_days: float | None, iq: IqFolder) -> None:
    """Beside a running server: soon after its start, then every few hours. Runs until cancelled; no error ends it.
    keep_days None: raw sweeps are kept for ever; paths are packed all the same.

    The wall's clock counts, as everywhere in retention: a sped-up mission is no older for it.
    """
    wait_s = FIRST_AFTER_S
    while True:
        await asyncio.sleep(wait_s)
        wait_s = EVERY_S
        try:
            buried = await bury(engine, DELETED_DAYS, datetime.now(UTC))
            if buried:
                log.info("%d missions deleted more than %g days ago are gone", buried, DELETED_DAYS)
            await pack_paths(engine, datetime.now(UTC))
            await thin_iq(engine, iq, keep_days, datetime.now(UTC))
            if keep_days is None:
                continue
            taken = await thin(engine, keep_days, datetime.now(UTC))
            if taken.sweeps:
                log.info("took %d raw sweeps older than %g days (%d bytes)", taken.sweeps, keep_days, taken.size_bytes)
        except Exception:
            log.exception("old raw sweeps or missions could not be taken; tried again later")
