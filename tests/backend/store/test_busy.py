"""A machine that is too busy to hear its database in time: said so, and not that the database is away."""

from __future__ import annotations

import asyncio
import sqlite3
import threading
from collections.abc import Sequence
from contextlib import suppress

import pytest
from sqlalchemy import Connection, make_url

from backend.events import HoldOrdered, MissionDrafted, Recorded
from backend.ports import JournalUnavailable
from backend.reasons.storage import DatabaseSilent, DatabaseTaken, DiskBusy, MachineBusy
from backend.spec import MissionSpec, Polygon
from backend.store import delivery, patience
from backend.store.brought import Brought
from backend.store.delivery import DatabaseAway
from backend.store.digest import fold
from backend.store.entries import Entry, to_row
from backend.store.journal import SqlJournal
from backend.store.patience import CrowdedError, StarvedError
from backend.store.reading import unanswered

SPEC = MissionSpec(name="s", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))

pytestmark = pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)


class Starving:
    """Writing is not heard to end in time, as long as `on`; `at_once`: more entries in one try than this are not."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, at_once: int = 0) -> None:
        self.on, self.tries, self.at_once = True, list[int](), at_once
        write = delivery.Delivery._write

        async def starved(this: delivery.Delivery, entries: list) -> None:
            self.tries.append(len(entries))
            if self.on and len(entries) > self.at_once:
                raise DatabaseAway(MachineBusy())
            await write(this, entries)

        monkeypatch.setattr(delivery.Delivery, "_write", starved)
        monkeypatch.setattr(delivery, "RETRY_FIRST_S", 0.01)
        monkeypatch.setattr(delivery, "RETRY_BUSY_S", 0.01)


async def until_ok(journal: SqlJournal) -> None:
    watch = asyncio.create_task(journal.run())
    async with asyncio.timeout(30):
        while journal.report().state != "ok":  # noqa: ASYNC110 (the report is polled by its users too)
            await asyncio.sleep(0.01)
    watch.cancel()
    with suppress(asyncio.CancelledError):
        await watch


def brought_of(mission_id: str, recorded: Sequence[Recorded]) -> Brought:
    renamed = [record.model_copy(update={"mission_id": mission_id}) for record in recorded]
    rows = tuple(to_row(record.seq, record.at_utc, record.event) for record in renamed)
    return Brought(mission_id, rows, fold(None, renamed), (), (), "crossfix")


async def flown(journal: SqlJournal, steps: int) -> None:
    await journal.append("m", [MissionDrafted(spec=SPEC)])
    for n in range(steps):
        await journal.append("m", [HoldOrdered(craft_id="craft-1", by=str(n), reason=None)])


async def test_what_is_said_is_that_the_machine_is_busy_and_nothing_is_lost(bench, monkeypatch) -> None:
    journal = await bench.open()
    starving = Starving(monkeypatch)
    await flown(journal, 3)
    report = journal.report()
    assert (report.state, report.spooled) == ("slow", 4)
    assert isinstance(report.reason, MachineBusy)
    starving.on = False
    await until_ok(journal)
    assert [record.seq for record in await (await bench.open("other.spool")).read("m")] == [1, 2, 3, 4]


async def test_what_waits_is_stored_in_ever_smaller_parts(bench, monkeypatch) -> None:
    """A whole batch that cannot be done in time would be tried for ever."""
    journal = await bench.open()
    starving = Starving(monkeypatch)
    await flown(journal, 20)
    starving.at_once = 3
    await until_ok(journal)
    assert starving.tries[:5] == [1, 21, 10, 5, 2]
    assert len(await (await bench.open("other.spool")).read("m")) == 21


async def test_a_database_that_refuses_is_away_however_busy_the_machine_was(bench, monkeypatch) -> None:
    journal = await bench.open()
    Starving(monkeypatch)
    await flown(journal, 1)
    journal._delivery.lost(DatabaseAway(unanswered(OSError(111, "Connection refused"), journal._engine)))
    report = journal.report()
    assert report.state == "lost"
    assert isinstance(report.reason, DatabaseSilent)


async def test_short_of_processors_is_no_slow_disk_and_excuses_no_server_elsewhere(bench, monkeypatch) -> None:
    journal = await bench.open()
    assert unanswered(TimeoutError(), journal._engine) == DiskBusy()
    assert unanswered(CrowdedError(), journal._engine) == MachineBusy()
    monkeypatch.setattr(journal._engine.dialect, "name", "postgresql")
    assert isinstance(unanswered(CrowdedError(), journal._engine), DatabaseSilent)


async def test_a_file_that_another_program_writes_to_is_taken_and_not_away(bench, monkeypatch) -> None:
    """As while a bundle is brought in: what is recorded meanwhile waits, and is stored when the other is done."""
    monkeypatch.setattr(delivery, "RETRY_FIRST_S", 0.01)
    bench.timeout_s = 3.0
    journal = await bench.open()
    await flown(journal, 0)
    other = sqlite3.connect(make_url(bench.url).database or "", isolation_level=None)
    other.execute("BEGIN IMMEDIATE")
    await journal.append("m", [HoldOrdered(craft_id="craft-1", by="anna", reason=None)])
    report = journal.report()
    assert (report.state, report.reason, report.spooled) == ("slow", DatabaseTaken(), 1)
    other.execute("ROLLBACK")
    other.close()
    await until_ok(journal)
    assert len(await (await bench.open("other.spool")).read("m")) == 2


async def test_a_flight_does_not_wait_for_a_bundle_that_is_brought_in(bench, monkeypatch) -> None:
    """Its facts go to the spool while the bundle's transaction has the file."""
    journal = await bench.open()
    await flown(journal, 0)
    begun, go_on = asyncio.Event(), asyncio.Event()

    async def long(*_: object) -> None:
        begun.set()
        await go_on.wait()

    monkeypatch.setattr("backend.store.journal.bring_in", long)
    recorded = await journal.read("m")
    brought = brought_of("elsewhere", recorded)
    bringing = asyncio.create_task(journal.bring_in(brought, "anna"))
    again = asyncio.create_task(journal.bring_in(brought_of("another", recorded), "anna"))
    try:
        async with asyncio.timeout(20):
            await begun.wait()
            await journal.append("m", [HoldOrdered(craft_id="craft-1", by="anna", reason=None)])
        assert not bringing.done()
        assert not again.done()
    finally:
        go_on.set()
    assert (await bringing, await again) == (True, True)


async def test_sqlite_that_is_late_on_an_idle_machine_waits_for_its_disk(bench, monkeypatch, tmp_path) -> None:
    # the machine of the tests may be busy itself
    monkeypatch.setattr(patience, "PROMPT_SHARE", 0.0)
    monkeypatch.setattr(patience, "PRESSURE", tmp_path)
    journal = await bench.open()
    await flown(journal, 0)
    held, write = threading.Event(), delivery._write

    def late(entries: Sequence[Entry], connection: Connection) -> None:
        held.wait(60)
        write(entries, connection)

    monkeypatch.setattr(delivery, "_write", late)
    await journal.append("m", [HoldOrdered(craft_id="craft-1", by="anna", reason=None)])
    report = journal.report()
    assert (report.state, report.reason, report.spooled) == ("slow", DiskBusy(), 1)
    held.set()
    await until_ok(journal)
    assert len(await (await bench.open("other.spool")).read("m")) == 2, "once, though it was written late as well"


async def test_a_reader_is_told_the_same(bench, monkeypatch) -> None:
    journal = await bench.open()

    def starved(_engine: object) -> None:
        raise StarvedError

    monkeypatch.setattr(type(journal._engine), "connect", starved)
    with pytest.raises(JournalUnavailable) as told:
        await journal.mission("m")
    assert isinstance(told.value.reason, MachineBusy)
