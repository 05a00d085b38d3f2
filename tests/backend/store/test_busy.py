"""A machine that is too busy to hear its database in time: said so, and not that the database is away."""

from __future__ import annotations

import asyncio
from contextlib import suppress

import pytest

from backend.events import HoldOrdered, MissionDrafted
from backend.ports import JournalUnavailable
from backend.reasons.storage import DatabaseSilent, MachineBusy
from backend.spec import MissionSpec, Polygon
from backend.store import delivery
from backend.store.journal import SqlJournal
from backend.store.patience import StarvedError

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
                raise delivery._away(StarvedError())
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
    journal._delivery.lost(delivery._away(OSError(111, "Connection refused")))
    report = journal.report()
    assert report.state == "lost"
    assert isinstance(report.reason, DatabaseSilent)


async def test_a_reader_is_told_the_same(bench, monkeypatch) -> None:
    journal = await bench.open()

    def starved(_engine: object) -> None:
        raise StarvedError

    monkeypatch.setattr(type(journal._engine), "connect", starved)
    with pytest.raises(JournalUnavailable) as told:
        await journal.mission("m")
    assert isinstance(told.value.reason, MachineBusy)
