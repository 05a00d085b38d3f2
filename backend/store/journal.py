"""The journal in a database: facts are durable before anybody hears of them, and a database that is away stops nothing.

How an entry reaches the database, or the spool while it is away, is `delivery`. Here are the order of a mission's facts
and what is read back: missions that are written to are kept in memory (see `written`), so their events can be read
meanwhile.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable, Collection, Coroutine, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from typing import Any, TypeVar

from sqlalchemy.ext.asyncio import AsyncEngine

from backend.beside import beside
from backend.events import Event, MissionBroughtIn, Recorded
from backend.ports import FactRefused, JournalDamaged, JournalUnavailable, Kept, Listed, TrackPoint
from backend.reasons.storage import FactUnfit, WrittenElsewhere
from backend.store.brought import Brought, bring_in
from backend.store.delivery import RETRY_FIRST_S, DatabaseAway, DatabaseReport, Delivery
from backend.store.digest import MissionDigest, fold
from backend.store.engine import dispose
from backend.store.entries import (
    Entry,
    EventRow,
    EventsEntry,
    JournalConflict,
    SweepEntry,
    TrackEntry,
    sweep_entry,
    to_records,
    to_row,
)
from backend.store.handed_over import HandedOver
from backend.store.reading import ANY, PlaceInList, StoredFacts, Wanted
from backend.store.spool import Spool
from backend.store.written import Written, left_in_database
from hardware.readings import Sweep

log = logging.getLogger("crossfix.store")

T = TypeVar("T")

START_PATIENCE_S = 20.0

PIECE = 500
"""Facts that are read, folded or compared at once."""

NETS_MISSIONS = 100
"""So many missions back a vehicle's own nets may still wait to be put back."""


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
        self._spool = spool
        self._delivery = Delivery(
            engine, spool, self._forget_ended, timeout_s=timeout_s, slow_s=slow_s, disk_low_bytes=disk_low_bytes
        )
        self._now = now
        self._lock = asyncio.Lock()
        """Over the numbers of a mission's facts."""
        self._bringing = asyncio.Lock()
        """One bundle after the other: a flight's facts wait for none."""
        self._written: dict[str, Written] = {}
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
            try:
                entry = _entry(mission_id, known.last_seq + 1, at_utc, events)
                recorded = to_records(mission_id, entry.rows)
                after = fold(known.digest, recorded)
            except ValueError as error:
                raise FactRefused(FactUnfit("journal", " ".join(str(error).split()).rstrip("."))) from error
            try:
                await self._delivery.store(entry)
            except JournalConflict:
                self._written.pop(mission_id, None)  # the next append reads what the other one wrote
                raise
            known.take(recorded, after)
            self._written[mission_id] = known
            self._forget_ended()
        return recorded

    async def append_unread(self, mission_id: str, events: Sequence[Event]) -> list[Recorded]:
        """As append, to a mission whose facts cannot be read. Raises FactRefused for one that is not there."""
        return await self._whole(self._append_unread(mission_id, events))

    async def _append_unread(self, mission_id: str, events: Sequence[Event]) -> list[Recorded]:
        async with self._lock:
            digest = await self._stored.mission(mission_id)
            last = max((row.seq for e in self._delivery.waiting_events(mission_id) for row in e.rows), default=0)
            last = max(last, 0 if digest is None else digest.last_seq)
            if digest is None:
                raise FactRefused(FactUnfit("journal", f"there is no mission {mission_id}"))
            entry = _entry(mission_id, last + 1, datetime.fromtimestamp(self._now(), UTC), events)
            await self._delivery.store(entry)
            return to_records(mission_id, entry.rows)

    async def bring_in(self, brought: Brought, by: str) -> bool:
        """A mission of another installation, with the times it had there, and the fact that it was brought in. All of
        it or nothing, into the database and never into the spool: it can be sent again. False: it is here already,
        with the same facts.

        Raises JournalUnavailable, JournalConflict when it is here with other facts.
        """
        return await self._whole(self._bring_in(brought, by))

    async def _bring_in(self, brought: Brought, by: str) -> bool:
        async with self._bringing:
            here = await self.mission(brought.mission_id)
            if here is not None:
                if not await self._begins_with(brought.mission_id, brought.rows):
                    raise JournalConflict(WrittenElsewhere(brought.mission_id, here.last_seq))
                return False
            at_utc = datetime.fromtimestamp(self._now(), UTC)
            await bring_in(self._engine, brought, at_utc, by)
            return True

    async def _begins_with(self, mission_id: str, rows: Sequence[EventRow]) -> bool:
        """rows: in today's form. Compared a piece at a time: all facts of a large mission at once, even in a thread,
        hold the event loop up for as long as the garbage collector looks at them."""
        for at in range(0, len(rows), PIECE):
            piece = rows[at : at + PIECE]
            here = await self.read(mission_id, at, len(piece))
            if await beside(len(here), _rows, here) != [*piece]:
                return False
        return True

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
        try:
            await self._delivery.store(entry)
        except FactRefused as error:
            await self._delivery.set_aside(entry, str(error))
            raise

    async def keep_aside(self, mission_id: str, events: Sequence[Event], why: str) -> None:
        """For a person to look at, in a file beside the spool; counted in the report."""
        at_utc = datetime.fromtimestamp(self._now(), UTC)
        await self._whole(self._delivery.set_aside(_entry(mission_id, 0, at_utc, events), why))

    async def _known(self, mission_id: str) -> Written:
        """The mission so far, what still waits in the spool included."""
        if mission_id in self._written:
            return self._written[mission_id]
        waiting = [row for entry in self._delivery.waiting_events(mission_id) for row in entry.rows]
        listed = None if waiting else await self._stored.mission(mission_id)
        if listed is not None and left_in_database(listed):
            return Written(listed, before=listed.last_seq)
        known = Written(None)
        while piece := await self._stored.read(mission_id, known.last_seq, most=PIECE):
            known.take(piece, await beside(len(piece), fold, known.digest, piece))
            if len(piece) < PIECE:
                break
        if missing := [row for row in waiting if row.seq > known.last_seq]:
            piece = await beside(len(missing), to_records, mission_id, missing)
            known.take(piece, await beside(len(piece), fold, known.digest, piece))
        return known

    # Being away and coming back

    async def start_up(self) -> None:
        """What an earlier server left in the spool is stored, or known until the database takes it.

        A database that is busy at this moment is waited for. Raises JournalUnavailable when it does not even read.
        """
        try:
            await self._delivery.drain()
        except Exception as error:
            if not isinstance(error, DatabaseAway):
                log.exception("what was spooled could not be stored yet; the watch over the database tries on")
            self._delivery.lost(error)
            waiting = {entry.mission_id for entry in self._delivery.waiting if isinstance(entry, EventsEntry)}
            for mission_id in waiting:
                with suppress(ValueError):  # facts that cannot be read: the watch keeps them aside
                    self._written[mission_id] = await self._patiently(lambda m=mission_id: self._known(m))

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
        await self._delivery.run()

    def _forget_ended(self) -> None:
        """Memory holds missions in flight only; an ended one is read from the database again."""
        if self._delivery.waiting:
            return
        for mission_id, known in list(self._written.items()):
            if known.digest is not None and known.digest.ended_at_us is not None and not known.digest.flying:
                del self._written[mission_id]

    def report(self) -> DatabaseReport:
        """From what the last attempts showed; asks nobody."""
        return self._delivery.report()

    async def close(self) -> None:
        """Wait for appends that run; what is spooled stays on disk for the next start."""
        await asyncio.gather(*self._tasks, return_exceptions=True)
        self._spool.close()
        await self._delivery.close()
        await dispose(self._engine)

    # Reading: missions in flight from memory, the rest from the database

    async def read(self, mission_id: str, after: int = 0, most: int | None = None) -> list[Recorded]:
        """Events with seq > after, in order, the first `most` of them; none for an unknown mission.

        Raises JournalUnavailable."""
        known = self._written.get(mission_id)
        if known is None:
            return await self._stored.read(mission_id, after, most=most)
        older = known.stored_only(after, most)
        stored = await self._stored.read(mission_id, after, most=older) if older else []
        return stored + known.here(after, most)

    async def read_texts(self, mission_id: str, after: int = 0, most: int | None = None) -> list[str]:
        """What `read` gives, each as the JSON that the wire tells. Raises JournalUnavailable."""
        known = self._written.get(mission_id)
        if known is None:
            return await self._stored.read_texts(mission_id, after, most)
        older = known.stored_only(after, most)
        stored = await self._stored.read_texts(mission_id, after, older) if older else []
        recorded = known.here(after, most)
        return stored + await asyncio.to_thread(lambda: [record.model_dump_json() for record in recorded])

    async def read_kinds(self, mission_id: str, kinds: Collection[str]) -> list[Recorded]:
        """The events of some kinds only."""
        known = self._written.get(mission_id)
        if known is None:
            return await self._stored.read(mission_id, kinds=kinds)
        stored = await self._stored.read(mission_id, kinds=kinds) if known.before else []
        here = [record for record in known.recorded if record.event.kind in kinds]
        return [record for record in stored if record.seq <= known.before] + here

    async def hand_over(self, mission_id: str) -> HandedOver:
        """What `read` gives, for a process of its own. Raises JournalUnavailable."""
        known = self._written.get(mission_id)
        stored = HandedOver((), {})
        if known is None or known.before:
            stored = await self._stored.hand_over(mission_id, PIECE, None if known is None else known.before)
        recorded = [] if known is None else known.here(0, None)
        here = [
            await asyncio.to_thread(_spooled, mission_id, recorded[at : at + PIECE])
            for at in range(0, len(recorded), PIECE)
        ]
        return HandedOver((*stored.pieces, *here), stored.imports)

    async def mission(self, mission_id: str) -> MissionDigest | None:
        """With what waits in the spool; None for an unknown mission."""
        if mission_id in self._written:
            return self._written[mission_id].digest
        return await self._stored.mission(mission_id)

    async def listed(self, mission_id: str) -> Listed | None:
        """See ports.Journal."""
        digest = await self.mission(mission_id)
        if digest is None:
            return None
        started_at_s = None if digest.started_at_us is None else digest.started_at_us / 1e6
        deleted = digest.entry.deleted_at_us is not None
        return Listed(started_at_s, digest.ended_at_us is not None, deleted, digest.crafts)

    async def missions(self) -> list[MissionDigest]:
        """All missions, newest first."""
        return await self._stored.missions()

    async def page(self, most: int, before: PlaceInList | None = None, wanted: Wanted = ANY) -> list[MissionDigest]:
        """A part of them, for a list that may hold thousands; see StoredFacts.page."""
        return await self._stored.page(most, before, wanted)

    async def of_nets(self) -> list[Recorded]:
        """Of the newest missions and of those in flight, oldest first: who flies a hundred missions puts the nets of
        the first back before."""
        newest = await self._patiently(lambda: self._stored.missions(NETS_MISSIONS))
        known = {digest.mission_id for digest in newest} | set(self._written) | set(await self.unfinished())
        stored = [d.mission_id for d in reversed(newest)] + sorted(known - {d.mission_id for d in newest})
        found: list[Recorded] = []
        for each in stored:
            with suppress(JournalDamaged):  # the others' nets are put back all the same
                of_one = await self.read_kinds(each, ("nets_noted", "nets_put_back", "mission_brought_in"))
                found += _of_this_installation(of_one)
        return found

    async def unfinished(self) -> list[str]:
        """Missions that were started and have not ended, or whose craft is not down yet; oldest start first. Asked at a
        start: a busy database is waited for."""
        known = {digest.mission_id: digest for digest in await self._patiently(self._stored.unfinished)}
        known |= {mission_id: written.digest for mission_id, written in self._written.items() if written.digest}
        going_on = [digest for digest in known.values() if digest.unfinished]
        return [d.mission_id for d in sorted(going_on, key=lambda d: (d.started_at_us, d.mission_id))]

    async def sweep(self, mission_id: str, sweep_id: str) -> SweepEntry | None:
        """Also one that still waits in the spool; None for an unknown one."""
        for waiting in self._delivery.waiting:
            if isinstance(waiting, SweepEntry) and (waiting.mission_id, waiting.sweep_id) == (mission_id, sweep_id):
                return waiting
        return await self._stored.sweep(mission_id, sweep_id)

    async def sweeps(self, mission_id: str) -> list[SweepEntry]:
        """All raw sweeps of a mission, by id, with what waits in the spool."""
        stored = {entry.sweep_id: entry for entry in await self._stored.sweeps(mission_id)}
        for waiting in self._delivery.waiting:
            if isinstance(waiting, SweepEntry) and waiting.mission_id == mission_id:
                stored[waiting.sweep_id] = waiting
        return [stored[sweep_id] for sweep_id in sorted(stored)]

    async def imported_sweeps(self) -> Kept:
        """The raw sweeps of recordings in the database. Raises JournalUnavailable."""
        return await self._stored.imported_sweeps()

    async def tracks(self, mission_id: str) -> dict[str, list[TrackPoint]]:
        """By craft, in time order."""
        return await self._stored.tracks(mission_id)


def _of_this_installation(recorded: Sequence[Recorded]) -> Sequence[Recorded]:
    """Without what came in with a bundle: those nets are of vehicles elsewhere."""
    brought = [at for at, record in enumerate(recorded) if isinstance(record.event, MissionBroughtIn)]
    return recorded[brought[-1] + 1 :] if brought else recorded


def _rows(recorded: Sequence[Recorded]) -> list[EventRow]:
    return [to_row(record.seq, record.at_utc, record.event) for record in recorded]


def _spooled(mission_id: str, recorded: Sequence[Recorded]) -> bytes:
    return EventsEntry(mission_id, tuple(_rows(recorded))).encode()


def _entry(mission_id: str, first: int, at_utc: datetime, events: Sequence[Event]) -> EventsEntry:
    return EventsEntry(mission_id, tuple(to_row(seq, at_utc, event) for seq, event in enumerate(events, start=first)))
