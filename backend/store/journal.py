"""The journal in a database: facts are durable before anybody hears of them, and a database that is away stops nothing.

An append goes to the database; when that fails or takes too long it goes to the spool on disk, in order, and a
background task drains the spool once the database answers again. `append` returns only when one of the two is durable.
Missions that are written to are kept in memory, so their events can be read while the database is away.
"""

from __future__ import annotations

import asyncio
import logging
import shutil
import time
from collections import deque
from collections.abc import Callable, Coroutine, Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import islice
from typing import Any, Literal, TypeVar

from sqlalchemy import exc, text
from sqlalchemy.ext.asyncio import AsyncEngine

from backend.events import Event, Recorded
from backend.ports import FactRefused, JournalUnavailable, TrackPoint
from backend.reasons.storage import DatabaseSilent, DatabaseSlow, DiskLow, FactUnfit, NothingStores
from backend.store.digest import MissionDigest, fold
from backend.store.entries import (
    Entry,
    EventsEntry,
    JournalConflict,
    SweepEntry,
    TrackEntry,
    decode,
    sweep_entry,
    to_records,
    to_row,
)
from backend.store.patience import patience
from backend.store.reading import StoredFacts, why
from backend.store.spool import Spool, SpoolFull
from hardware.readings import Sweep

log = logging.getLogger("crossfix.store")

T = TypeVar("T")

RETRY_FIRST_S, RETRY_LAST_S = 0.25, 5.0
PROBE_S = 1.0
DRAIN_BATCH = 64
START_PATIENCE_S = 20.0

REFUSED = (JournalConflict, exc.IntegrityError, exc.DataError, exc.ProgrammingError)
"""The database answered, and will never take this entry."""


class DatabaseAway(RuntimeError):
    """The database did not answer; nothing is known about the last transaction."""


@dataclass(frozen=True, slots=True)
class DatabaseReport:
    """reason: None when all is well. spooled: entries on disk that wait for the database. refused: entries that it will
    never take (kept in a file)."""

    state: Literal["ok", "slow", "lost"]
    reason: DatabaseSilent | DatabaseSlow | DiskLow | None
    spooled: int
    refused: int


NETS_MISSIONS = 100
"""So many missions back a vehicle's own nets may still wait to be put back."""


@dataclass(slots=True)
class Written:
    """A mission that was written to: all its events, and what they add up to (None before the first)."""

    recorded: list[Recorded]
    digest: MissionDigest | None


class SqlJournal:
    """backend.ports.Journal on SQLAlchemy, and what the API reads. Use `run` as a background task."""

    def __init__(
        self,
        engine: AsyncEngine,
        spool: Spool,
        now: Callable[[], float],
        *,
        timeout_s: float = 2.0,
        slow_s: float = 0.5,
        disk_low_bytes: int = 0,
    ) -> None:
        self._engine = engine
        self._stored = StoredFacts(engine, 2 * timeout_s)
        self._writer = engine.execution_options(write=True)
        self._spool = spool
        self._now = now
        self._timeout_s = timeout_s
        self._slow_s = slow_s
        self._disk_low_bytes = disk_low_bytes
        self._lock = asyncio.Lock()
        self._pending = deque(decode(payload) for payload in spool.entries())
        self._written: dict[str, Written] = {}
        self._wake = asyncio.Event()
        self._fault: str | None = None
        self._answers = True
        self._took_s = 0.0
        self._refused = 0
        self._disk_free_bytes: int | None = None
        self._tasks: set[asyncio.Task[Any]] = set()

    # Writing

    async def append(self, mission_id: str, events: Sequence[Event]) -> list[Recorded]:
        """Durable when it returns, and done whole even when the caller is cancelled meanwhile.

        What is returned is what will be read back. Raises JournalUnavailable when neither database nor spool takes it,
        FactRefused for what makes no sense, JournalConflict when another process writes to the same mission.
        """
        return await self._whole(self._append(mission_id, events))

    async def _whole(self, work: Coroutine[Any, Any, T]) -> T:
        """Run to the end even when the caller is cancelled: a half-known write would leave a gap or a double."""
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return await asyncio.shield(task)

    async def _append(self, mission_id: str, events: Sequence[Event]) -> list[Recorded]:
        if not events:
            return []
        async with self._lock:
            known = await self._known(mission_id)
            at_utc = datetime.fromtimestamp(self._now(), UTC)
            entry = _entry(mission_id, len(known.recorded) + 1, at_utc, events)
            try:
                recorded = to_records(mission_id, entry.rows)
                after = fold(known.digest, recorded)
            except ValueError as error:
                raise FactRefused(FactUnfit("journal", " ".join(str(error).split()).rstrip("."))) from error
            try:
                await self._store(entry)
            except JournalConflict:
                self._written.pop(mission_id, None)  # the next append reads what the other one wrote
                raise
            known.recorded.extend(recorded)
            known.digest = after
            self._written[mission_id] = known
            self._forget_ended()
        return recorded

    async def save_sweep(
        self,
        mission_id: str,
        sweep_id: str,
        craft_id: str | None,
        emitter_id: str,
        place_number: int,
        attempt: int,
        sweep: Sweep,
    ) -> None:
        """Returns when it is durable, in the database or the spool. Raises FactRefused."""
        entry = sweep_entry(mission_id, sweep_id, craft_id, emitter_id, place_number, attempt, sweep)
        await self._whole(self._save(entry))

    async def save_track(self, mission_id: str, craft_id: str, points: Sequence[TrackPoint]) -> None:
        """Returns when they are durable, in the database or the spool. Raises FactRefused."""
        if points:
            await self._whole(self._save(TrackEntry(mission_id, craft_id, tuple(points))))

    async def _save(self, entry: Entry) -> None:
        async with self._lock:
            try:
                await self._store(entry)
            except FactRefused as error:
                await self._set_aside(entry, str(error))
                raise

    async def keep_aside(self, mission_id: str, events: Sequence[Event], why: str) -> None:
        """For a person to look at, in a file beside the spool; counted in the report."""
        at_utc = datetime.fromtimestamp(self._now(), UTC)
        await self._whole(self._set_aside(_entry(mission_id, 0, at_utc, events), why))

    async def _set_aside(self, entry: Entry, why: str) -> None:
        self._refused += 1
        log.error("kept aside, it cannot be stored: %s", why)
        try:
            await asyncio.to_thread(self._spool.keep_aside, entry.encode())
        except OSError as error:
            log.error("it could not be kept aside either (%s): %s", error.strerror, entry.encode().decode())

    async def _known(self, mission_id: str) -> Written:
        """The mission so far, what still waits in the spool included."""
        if mission_id not in self._written:
            recorded = await self._stored.read(mission_id)
            waiting = [
                row
                for entry in self._pending
                if isinstance(entry, EventsEntry) and entry.mission_id == mission_id
                for row in entry.rows
            ]
            recorded += to_records(mission_id, [row for row in waiting if row.seq > len(recorded)])
            return Written(recorded, fold(None, recorded) if recorded else None)
        return self._written[mission_id]

    async def _store(self, entry: Entry) -> None:
        """To the database, or behind what already waits in the spool."""
        if not self._pending and self._fault is None:
            try:
                await self._write([entry])
            except DatabaseAway as error:
                self._lost(error)
            except JournalConflict:
                raise
            except REFUSED as error:
                raise FactRefused(FactUnfit("database", why(error))) from error
            else:
                return
        try:
            await asyncio.to_thread(self._spool.append, entry.encode())
        except SpoolFull as error:
            raise JournalUnavailable(NothingStores(self._fault or "it still takes what waited", str(error))) from error
        self._pending.append(entry)
        self._wake.set()

    async def _write(self, entries: Sequence[Entry]) -> None:
        """All in one transaction. Raises DatabaseAway, and what `REFUSED` names."""
        began = time.monotonic()
        try:
            async with patience(self._timeout_s), self._writer.begin() as connection:
                for entry in entries:
                    await entry.write(connection)
        except REFUSED:
            raise
        except (exc.DBAPIError, exc.TimeoutError, OSError) as error:
            raise DatabaseAway(why(error)) from error
        finally:
            self._took_s = time.monotonic() - began

    # Being away and coming back

    def _lost(self, error: DatabaseAway) -> None:
        if self._fault is None:
            log.error("database away: %s; events are spooled", error)
        self._fault, self._answers = str(error), False
        self._wake.set()

    async def start_up(self) -> None:
        """What an earlier server left in the spool is stored, or known until the database takes it.

        A database that is busy at this moment is waited for. Raises JournalUnavailable when it does not even read.
        """
        try:
            await self.drain()
        except DatabaseAway as error:
            self._lost(error)
            for mission_id in {entry.mission_id for entry in self._pending if isinstance(entry, EventsEntry)}:
                self._written[mission_id] = await self._patiently(lambda mission_id=mission_id: self._known(mission_id))

    @staticmethod
    async def _patiently(read: Callable[[], Coroutine[Any, Any, T]]) -> T:
        """Raises JournalUnavailable when the database does not answer for START_PATIENCE_S."""
        until = time.monotonic() + START_PATIENCE_S
        while True:
            try:
                return await read()
            except JournalUnavailable:
                if time.monotonic() > until:
                    raise
                await asyncio.sleep(RETRY_FIRST_S)

    async def run(self) -> None:
        """Watch the database, and drain the spool when it is back. Runs until cancelled."""
        retry_s = RETRY_FIRST_S
        while True:
            if self._pending or self._fault is not None:
                try:
                    await self.drain()
                    retry_s = RETRY_FIRST_S
                except DatabaseAway as error:
                    self._lost(error)
                    await asyncio.sleep(retry_s)
                    retry_s = min(2 * retry_s, RETRY_LAST_S)
                continue
            self._disk_free_bytes = shutil.disk_usage(self._spool.path).free
            self._wake.clear()
            try:
                async with asyncio.timeout(PROBE_S):
                    await self._wake.wait()
            except TimeoutError:
                try:
                    await self._probe()
                except DatabaseAway as error:
                    self._lost(error)

    async def _probe(self) -> None:
        began = time.monotonic()
        try:
            async with patience(self._timeout_s), self._engine.connect() as connection:
                await connection.execute(text("SELECT 1"))
        except (exc.DBAPIError, exc.TimeoutError, OSError) as error:
            raise DatabaseAway(why(error)) from error
        self._took_s = time.monotonic() - began

    async def drain(self) -> None:
        """Everything that waits, in order; appends meanwhile queue up behind it. Raises DatabaseAway."""
        await self._probe()
        drained = 0
        while self._pending:
            batch = list(islice(self._pending, DRAIN_BATCH))
            try:
                await self._write(batch)
            except REFUSED:
                del batch[1:]
                await self._write_or_keep_aside(batch[0])
            drained += len(batch)
            self._answers = True  # slow until the rest is stored, but away no longer
            for _ in batch:
                self._pending.popleft()
        async with self._lock:
            if not self._pending:
                await asyncio.to_thread(self._spool.clear)
                if self._fault is not None:
                    log.warning("database back, %d spooled entries stored", drained)
                self._fault = None
                self._forget_ended()

    async def _write_or_keep_aside(self, entry: Entry) -> None:
        try:
            await self._write([entry])
        except REFUSED as error:
            await self._set_aside(entry, f"the database refuses a spooled entry: {error}")

    def _forget_ended(self) -> None:
        """Memory holds missions in flight only; an ended one is read from the database again."""
        if self._pending:
            return
        for mission_id, known in list(self._written.items()):
            if known.digest is not None and known.digest.ended_at_us is not None and not known.digest.flying:
                del self._written[mission_id]

    def report(self) -> DatabaseReport:
        """From what the last attempts showed; asks nobody."""
        waiting = len(self._pending)
        if self._fault is not None and not self._answers:
            return DatabaseReport("lost", DatabaseSilent(self._fault), waiting, self._refused)
        if waiting or self._fault is not None or self._took_s > self._slow_s:
            return DatabaseReport("slow", DatabaseSlow(self._took_s), waiting, self._refused)
        if self._disk_free_bytes is not None and self._disk_free_bytes < self._disk_low_bytes:
            return DatabaseReport("slow", DiskLow(self._disk_free_bytes), 0, self._refused)
        return DatabaseReport("ok", None, 0, self._refused)

    async def close(self) -> None:
        """Wait for appends that run; what is spooled stays on disk for the next start."""
        await asyncio.gather(*self._tasks, return_exceptions=True)
        self._spool.close()
        await self._engine.dispose()

    # Reading: missions in flight from memory, the rest from the database

    async def read(self, mission_id: str, after: int = 0) -> list[Recorded]:
        """Events with seq > after, in order; none for an unknown mission. Raises JournalUnavailable."""
        if mission_id in self._written:
            return self._written[mission_id].recorded[after:]
        return await self._stored.read(mission_id, after)

    async def read_kinds(self, mission_id: str, kinds: Iterable[str]) -> list[Recorded]:
        """The events of some kinds only."""
        wanted = set(kinds)
        if mission_id in self._written:
            return [record for record in self._written[mission_id].recorded if record.event.kind in wanted]
        return await self._stored.read(mission_id, kinds=wanted)

    async def mission(self, mission_id: str) -> MissionDigest | None:
        """With what waits in the spool; None for an unknown mission."""
        if mission_id in self._written:
            return self._written[mission_id].digest
        return await self._stored.mission(mission_id)

    async def missions(self) -> list[MissionDigest]:
        """All missions, newest first."""
        return await self._stored.missions()

    async def of_nets(self) -> list[Recorded]:
        """Of the newest missions, oldest first: who flies a hundred missions puts the nets of the first back before."""
        newest = (await self._patiently(self._stored.missions))[:NETS_MISSIONS]
        known = {digest.mission_id for digest in newest} | set(self._written)
        stored = [d.mission_id for d in reversed(newest)] + sorted(known - {d.mission_id for d in newest})
        return [record for each in stored for record in await self.read_kinds(each, ("nets_noted", "nets_put_back"))]

    async def unfinished(self) -> list[str]:
        """Missions that were started and have not ended, or whose craft is not down yet; oldest start first. Asked at a
        start: a busy database is waited for."""
        known = {digest.mission_id: digest for digest in await self._patiently(self._stored.unfinished)}
        known |= {mission_id: written.digest for mission_id, written in self._written.items() if written.digest}
        going_on = [digest for digest in known.values() if digest.unfinished]
        return [d.mission_id for d in sorted(going_on, key=lambda d: (d.started_at_us, d.mission_id))]

    async def sweep(self, mission_id: str, sweep_id: str) -> SweepEntry | None:
        """Also one that still waits in the spool; None for an unknown one."""
        for waiting in self._pending:
            if isinstance(waiting, SweepEntry) and (waiting.mission_id, waiting.sweep_id) == (mission_id, sweep_id):
                return waiting
        return await self._stored.sweep(mission_id, sweep_id)

    async def tracks(self, mission_id: str) -> dict[str, list[TrackPoint]]:
        """By craft, in time order."""
        return await self._stored.tracks(mission_id)


def _entry(mission_id: str, first: int, at_utc: datetime, events: Sequence[Event]) -> EventsEntry:
    return EventsEntry(mission_id, tuple(to_row(seq, at_utc, event) for seq, event in enumerate(events, start=first)))
