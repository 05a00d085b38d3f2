"""How long raw sweeps and IQ are kept: of missions that are over, for as many days as the setting says; everything else
for ever, and the flown path packed as soon as the mission is over.

A bearing's power samples take some 16 kB, its facts 8 kB, and the path flown for it 20 kB in rows and 1 kB packed.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Collection
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from functools import partial
from typing import Any, Protocol

from sqlalchemy import ColumnElement, delete, func, select, true, tuple_
from sqlalchemy.ext.asyncio import AsyncConnection, AsyncEngine

from backend.ports import TrackPoint
from backend.store.days_seen import DaysSeen
from backend.store.digest import to_us
from backend.store.iq_folder import IqFolder
from backend.store.paths import MOST_POINTS, packed_path
from backend.store.tables import events, missions, paths, sweeps, tracks

log = logging.getLogger("crossfix.store")

DELETED_DAYS = 30.0
"""For this many days a deleted mission can be restored."""
SEEN_OLD_DAYS = 30.0
"""The clock may be wrong, so raw sweeps that it calls old stay until the server has run on this many further days, or
on as many as the rule has, if that is fewer."""
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


def _old_among(keep_days: float, now: datetime, among: Collection[str] | None) -> ColumnElement[bool]:
    old = _old(keep_days, now)
    return old if among is None else old & missions.c.mission_id.in_(among)


async def old_sweeps(engine: AsyncEngine, keep_days: float, now: datetime) -> Thinned:
    """What the rule would take. Raises what the driver raises."""
    return await _counted(engine, _old(keep_days, now))


async def _counted(engine: AsyncEngine, old: ColumnElement[bool]) -> Thinned:
    query = select(
        func.count(sweeps.c.mission_id.distinct()),
        func.count(),
        func.coalesce(func.sum(func.length(sweeps.c.samples)), 0),
    ).where(sweeps.c.mission_id == missions.c.mission_id, old)
    async with engine.connect() as connection:
        of, count, size = (await connection.execute(query)).one()
    return Thinned(int(of), int(count), int(size))


async def thin(engine: AsyncEngine, keep_days: float, now: datetime, among: Collection[str] | None = None) -> Thinned:
    """Take the raw sweeps that are older than the rule, a few at a time. among: of these missions only; None: of
    whichever. Raises what the driver raises."""
    old = _old_among(keep_days, now, among)
    found = await _counted(engine, old)
    writer = engine.execution_options(write=True)
    taken = 0
    while taken < found.sweeps:
        async with writer.begin() as connection:
            chosen = (
                select(sweeps.c.mission_id, sweeps.c.sweep_id)
                .where(sweeps.c.mission_id == missions.c.mission_id, old)
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
    many pieces. A path that cannot be packed stays as it is. Raises what the driver raises."""
    packed, done = 0, ("", "")
    while True:
        key = tuple_(tracks.c.mission_id, tracks.c.craft_id)
        query = select(tracks.c.mission_id, tracks.c.craft_id).where(tracks.c.mission_id == missions.c.mission_id)
        query = query.where(_old(0.0, now), key > done).order_by(tracks.c.mission_id, tracks.c.craft_id).limit(1)
        async with engine.connect() as connection:
            found = (await connection.execute(query)).first()
        if found is None:
            return packed
        done = (found.mission_id, found.craft_id)
        try:
            packed += await _pack_path(engine, *done)
        except ValueError as error:
            log.error("the path of %s in mission %s stays unpacked: %s", found.craft_id, found.mission_id, error)


async def _pack_path(engine: AsyncEngine, mission_id: str, craft_id: str) -> int:
    """All that lies in rows of one path; how many pieces. Raises ValueError."""
    packed = 0
    while True:
        async with engine.execution_options(write=True).begin() as connection:
            taken = await _pack_piece(connection, mission_id, craft_id)
        if taken is None:
            return packed
        packed += taken
        await asyncio.sleep(PAUSE_S)


async def _pack_piece(connection: AsyncConnection, mission_id: str, craft_id: str) -> int | None:
    """The first hour of what lies in rows; how many pieces it made, None when there was nothing. Raises ValueError.

    The rows that the database says it deleted are those that are packed, whatever is written at the same time.
    """
    here = (tracks.c.mission_id == mission_id) & (tracks.c.craft_id == craft_id)
    hour = select(tracks.c.at_us).where(here).order_by(tracks.c.at_us).limit(MOST_POINTS).subquery()
    columns = [column for column in tracks.c if column.name not in ("mission_id", "craft_id")]
    taking = delete(tracks).where(here, tracks.c.at_us <= select(func.max(hour.c.at_us)).scalar_subquery())
    rows: list[Any] = sorted(await connection.execute(taking.returning(*columns)), key=lambda row: row.at_us)
    if not rows:
        return None
    same = (paths.c.mission_id == mission_id) & (paths.c.craft_id == craft_id)
    begun = set(await connection.scalars(select(paths.c.at_us).where(same)))
    new = [row for row in rows if row.at_us not in begun]  # those came again out of a spool
    pieces = [new[at : at + MOST_POINTS] for at in range(0, len(new), MOST_POINTS)]
    for piece in pieces:
        points = [TrackPoint(at_us / 1e6, *told) for at_us, *told in piece]
        key = {"mission_id": mission_id, "craft_id": craft_id, "at_us": piece[0].at_us}
        await connection.execute(paths.insert().values(**key, points=await asyncio.to_thread(packed_path, points)))
    return len(pieces)


async def bury(engine: AsyncEngine, keep_days: float, now: datetime, among: Collection[str] | None = None) -> int:
    """Missions that were deleted longer ago go for good, with all that is kept of them, one in a transaction. How many.
    among: only these; None: whichever. Raises what the driver raises."""
    gone = (missions.c.deleted_at_us < to_us(now - timedelta(days=keep_days))) & ~missions.c.flying
    if among is not None:
        gone &= missions.c.mission_id.in_(among)
    writer = engine.execution_options(write=True)
    one = select(missions.c.mission_id).where(gone).limit(1).with_for_update()  # a restoration waits, or is waited for
    taken = 0
    while True:
        async with writer.begin() as connection:
            mission_id = (await connection.execute(one)).scalar()
            if mission_id is None:
                return taken
            for table in (sweeps, tracks, paths, events, missions):
                await connection.execute(delete(table).where(table.c.mission_id == mission_id))
        taken += 1
        await asyncio.sleep(PAUSE_S)


class Beside(Protocol):
    """Files that are kept beside the database, by mission."""

    def missions(self) -> list[str]:
        """Of which anything is kept."""
        ...

    def forget(self, mission_ids: Collection[str]) -> None:
        """All of them. Raises OSError."""
        ...


async def forget_gone(engine: AsyncEngine, beside: Beside) -> list[str]:
    """What is kept of missions that are gone. Their ids. Raises what the driver raises, OSError."""
    return await _forget(engine, beside, true())


async def thin_iq(
    engine: AsyncEngine, iq: IqFolder, keep_days: float | None, now: datetime, among: Collection[str] | None = None
) -> list[str]:
    """Take the IQ of missions that are older than the rule, and of those that are gone. Their ids. Raises what the
    driver raises. keep_days None: IQ of missions that are there is kept for ever. among: as in `thin`."""
    return await _forget(engine, iq, true() if keep_days is None else ~_old_among(keep_days, now, among))


async def _forget(engine: AsyncEngine, beside: Beside, stays: ColumnElement[bool]) -> list[str]:
    """What is kept beside the database of missions that are not there, or not to stay."""
    kept = await asyncio.to_thread(beside.missions)
    staying: set[str] = set()
    async with engine.connect() as connection:
        for at in range(0, len(kept), AT_ONCE):
            named = missions.c.mission_id.in_(kept[at : at + AT_ONCE])
            staying |= set(await connection.scalars(select(missions.c.mission_id).where(named & stays)))
    taken = [mission_id for mission_id in kept if mission_id not in staying]
    await asyncio.to_thread(beside.forget, taken)
    return taken


async def keep_thin(
    engine: AsyncEngine, keep_days: float | None, seen: tuple[DaysSeen, DaysSeen], iq: IqFolder, *others: Beside
) -> None:
    """Beside a running server: soon after its start, then every few hours. Runs until cancelled; no error ends it.
    keep_days None: raw sweeps are kept for ever; paths are packed all the same. seen: where days are counted for
    deleted missions, and for those whose sweeps are old. others: kept as long as the mission.

    The wall clock counts, as everywhere in retention: a sped-up mission is no older for it. Since it may be wrong by
    years, a deleted mission also stays until the server has run on thirty days more (see `DaysSeen`), and so do sweeps
    that are old by the clock.
    """
    deleted, old = seen
    wait_s = FIRST_AFTER_S
    while True:
        await asyncio.sleep(wait_s)
        wait_s = EVERY_S
        now = datetime.now(UTC)
        beside = (partial(_take_gone, other) for other in (iq, *others))
        rule = () if keep_days is None else (_take_iq, _take_sweeps)
        thinning = (partial(chore, keep_days or 0.0, old, iq) for chore in rule)
        for chore in (partial(_bury, deleted), pack_paths, *beside, *thinning):
            try:
                await chore(engine, now)
            except Exception:
                log.exception("old raw sweeps, paths or missions could not be taken; tried again later")


async def _bury(days: DaysSeen, engine: AsyncEngine, now: datetime) -> None:
    async with engine.connect() as connection:
        query = select(missions.c.mission_id).where(missions.c.deleted_at_us.is_not(None))
        deleted = list(await connection.scalars(query))
    counted = await asyncio.to_thread(days.count, deleted, now.date())
    due = [name for name in deleted if counted[name] >= DELETED_DAYS]
    buried = 0
    for at in range(0, len(due), AT_ONCE):
        buried += await bury(engine, DELETED_DAYS, now, due[at : at + AT_ONCE])
    if buried:
        log.info("%d missions deleted more than %g days ago are gone", buried, DELETED_DAYS)


async def _take_gone(beside: Beside, engine: AsyncEngine, _now: datetime) -> None:
    await forget_gone(engine, beside)


async def _due(keep_days: float, days: DaysSeen, iq: IqFolder, engine: AsyncEngine, now: datetime) -> list[str]:
    """Missions with raw sweeps or IQ that have been older than the rule for long enough."""
    kept = await asyncio.to_thread(iq.missions)
    of_sweeps = select(sweeps.c.mission_id).where(sweeps.c.mission_id == missions.c.mission_id).exists()
    query = select(missions.c.mission_id).where(_old(keep_days, now), of_sweeps | missions.c.mission_id.in_(kept))
    async with engine.connect() as connection:
        old = list(await connection.scalars(query))
    counted = await asyncio.to_thread(days.count, old, now.date())
    return [name for name in old if counted[name] >= min(keep_days, SEEN_OLD_DAYS)]


async def _take_iq(keep_days: float, days: DaysSeen, iq: IqFolder, engine: AsyncEngine, now: datetime) -> None:
    await thin_iq(engine, iq, keep_days, now, await _due(keep_days, days, iq, engine, now))


async def _take_sweeps(keep_days: float, days: DaysSeen, iq: IqFolder, engine: AsyncEngine, now: datetime) -> None:
    taken = await thin(engine, keep_days, now, await _due(keep_days, days, iq, engine, now))
    if taken.sweeps:
        log.info("took %d raw sweeps older than %g days (%d bytes)", taken.sweeps, keep_days, taken.size_bytes)
