"""A fact is written in one go: an order to hold waits for the disk, and not for turns at the interpreter."""

from __future__ import annotations

import asyncio
import threading

import pytest
from sqlalchemy import Connection, text

from backend.events import HoldOrdered, MissionDrafted
from backend.spec import MissionSpec, Polygon
from backend.store.engine import make_engine
from backend.store.patience import patience
from backend.store.transactions import transactions_of

SPEC = MissionSpec(name="s", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))
OF_PATIENCE = "crossfix-idle"


def hold(by: str) -> HoldOrdered:
    return HoldOrdered(craft_id="craft-1", by=by, reason=None)


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
async def test_threads_come_back_to_the_loop_once_for_each_fact(journal, monkeypatch) -> None:
    await journal.append("m", [MissionDrafted(spec=SPEC)])
    loop, crossings = asyncio.get_running_loop(), list[str]()
    wake = loop.call_soon_threadsafe

    def counted(*given, **more):
        if not threading.current_thread().name.startswith(OF_PATIENCE):
            crossings.append(threading.current_thread().name)
        return wake(*given, **more)

    monkeypatch.setattr(loop, "call_soon_threadsafe", counted)
    for n in range(3):
        await journal.append("m", [hold(str(n))])
    assert len(crossings) == 3, crossings
    assert [record.seq for record in await journal.read("m")] == [1, 2, 3, 4]


def count(connection: Connection) -> int:
    return connection.execute(text("SELECT count(*) FROM invitations")).scalar_one()


async def test_of_work_that_fails_nothing_is_stored(bench) -> None:
    engine = make_engine(bench.url, 2.0)
    transactions, seen = transactions_of(engine, 2.0), list[int]()

    def failing(connection: Connection) -> None:
        connection.execute(text("CREATE TABLE made_meanwhile (n INTEGER)"))
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        await transactions.run(failing)
    await transactions.run(lambda connection: seen.append(count(connection)))
    assert seen == [0]
    with pytest.raises(Exception, match="made_meanwhile"):
        await transactions.run(lambda connection: connection.execute(text("SELECT n FROM made_meanwhile")) and None)
    await transactions.close()
    await engine.dispose()


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
async def test_what_was_not_begun_when_its_caller_gave_up_is_never_done(bench) -> None:
    engine = make_engine(bench.url, 2.0)
    transactions, done = transactions_of(engine, 2.0), list[str]()
    began, go_on = threading.Event(), threading.Event()

    def held_up(_connection: Connection) -> None:
        began.set()
        assert go_on.wait(60)
        done.append("first")

    first = asyncio.create_task(transactions.run(held_up))
    assert await asyncio.to_thread(began.wait, 60)
    with pytest.raises(TimeoutError):
        async with patience(0.2):
            await transactions.run(lambda _connection: done.append("given up"))
    go_on.set()
    await first
    await transactions.run(lambda _connection: done.append("last"))
    assert done == ["first", "last"]
    await transactions.close()
    await engine.dispose()
