"""The database goes away in flight: nothing waits long, nothing is lost, everything is stored exactly once."""

from __future__ import annotations

import asyncio
import os
import random
import sqlite3
import subprocess
import sys

import asyncpg
import numpy as np
import pytest
from narrowing import known
from sqlalchemy import make_url
from written_flight import DRAFT, STARTED, SWEEP, Flight, hold, until, watched

from backend.ports import TrackPoint
from backend.reasons.storage import DatabaseSilent, DatabaseTaken
from backend.settings import Settings
from backend.store import delivery
from backend.store.entries import TrackEntry
from backend.store.opening import open_journal
from backend.store.reading import JournalUnavailable
from backend.store.spool import Spool


@pytest.fixture
def outage(request: pytest.FixtureRequest, bench):
    """Takes the database away in the way the parameter names, and brings it back."""
    return request.param(bench, request)


class Locked:
    """SQLite: another program holds the file for writing."""

    stops_reading, said = False, ("slow", DatabaseTaken)

    def __init__(self, bench, _request) -> None:
        self.path = known(make_url(bench.url).database)

    def begin(self) -> None:
        self.other = sqlite3.connect(self.path, isolation_level=None, check_same_thread=False)
        self.other.execute("BEGIN EXCLUSIVE")

    def end(self) -> None:
        self.other.execute("ROLLBACK")
        self.other.close()


class Stopped:
    """PostgreSQL: its machine lost its power."""

    stops_reading, said = True, ("lost", DatabaseSilent)

    def __init__(self, _bench, request) -> None:
        self.cluster = request.getfixturevalue("postgres_cluster")

    def begin(self) -> None:
        self.cluster.stop()

    def end(self) -> None:
        self.cluster.start()


class Hanging(Stopped):
    """PostgreSQL: connections stay, nothing answers."""

    def begin(self) -> None:
        self.cluster.pause()

    def end(self) -> None:
        self.cluster.resume()


@pytest.mark.skipif("CROSSFIX_TEST_POSTGRESQL_URL" in os.environ, reason="a given PostgreSQL is not ours to stop")
@pytest.mark.parametrize(
    ("database_url", "outage"),
    [("sqlite", Locked), ("postgresql", Stopped), ("postgresql", Hanging)],
    indirect=True,
    ids=["locked", "stopped", "hanging"],
)
async def test_flight_goes_on_while_the_database_is_away(bench, outage):
    journal = await bench.open()
    flight = Flight(journal)
    await flight.begin()
    async with watched(journal):
        for _ in range(2):
            await flight.go_on(3)
            await asyncio.to_thread(outage.begin)
            try:
                await flight.go_on(4)
                assert (journal.report().state, type(journal.report().reason)) == outage.said
                assert journal.report().spooled == 12
                assert len(await journal.read("m")) == flight.count + 2
                waiting = await journal.sweep("m", f"s{flight.count - 1}")
                assert waiting is not None
                np.testing.assert_array_equal(waiting.sweep().power_db, SWEEP.power_db)
                if outage.stops_reading:
                    with pytest.raises(JournalUnavailable):
                        await journal.read("another")
            finally:
                await asyncio.to_thread(outage.end)
            await until(journal, "ok")
        await flight.go_on(2)
    await flight.check(await bench.open("other.spool"))


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
async def test_a_server_killed_in_the_outage_drains_the_spool_at_its_next_start(bench, tmp_path):
    journal = await bench.open()
    flight = Flight(journal)
    await flight.begin()
    outage = Locked(bench, None)
    outage.begin()
    await flight.go_on(3)
    outage.end()
    await bench.close()
    async with open_journal(Settings(data_dir=tmp_path, database_url=bench.url), lambda: 0.0) as again:
        assert again.report().spooled == 0
        await flight.check(again)
        assert (await again.append("m", [hold(99)]))[0].seq == flight.count + 3


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
async def test_a_start_beside_a_busy_database_goes_on_with_the_spool(bench, tmp_path):
    """Another program holds the file for writing while the server starts: what was spooled is known all the same."""
    journal = await bench.open()
    flight = Flight(journal)
    await flight.begin()
    outage = Locked(bench, None)
    outage.begin()
    await flight.go_on(2)
    await bench.close()
    outage.end()
    writer = sqlite3.connect(outage.path, isolation_level=None, check_same_thread=False)
    writer.execute("BEGIN IMMEDIATE")
    again = await bench.open()
    await again.start_up()
    assert again.report().reason == DatabaseTaken()
    assert again.report().spooled == 6
    assert await again.unfinished() == ["m"]
    assert [record.seq for record in await again.read("m")] == [1, 2, 3, 4]
    assert (await again.append("m", [hold(2)]))[0].seq == 5
    writer.execute("ROLLBACK")
    writer.close()
    async with watched(again):
        await until(again, "ok")
    assert [record.seq for record in await (await bench.open("other.spool")).read("m")] == [1, 2, 3, 4, 5]


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
async def test_an_entry_the_database_refuses_is_kept_aside_and_blocks_nothing(bench, tmp_path):
    journal = await bench.open()
    flight = Flight(journal)
    await flight.begin()
    outage = Locked(bench, None)
    outage.begin()
    point = TrackPoint(1.7e9, 50.6, 7.2, 140.0, 40.0, 0.0, None, None)
    await journal.save_track("no such mission", "craft-1", [point])
    await flight.go_on(1)
    outage.end()
    async with watched(journal):
        await until(journal, "ok")
    assert journal.report().refused == 1
    assert "no such mission" in (tmp_path / "journal.refused").read_text()
    await flight.check(journal)


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
@pytest.mark.parametrize("error", [RuntimeError("unforeseen"), OSError(5, "Input/output error"), KeyError("x")])
async def test_no_error_ends_the_watch_and_it_drains_afterwards(bench, monkeypatch, error):
    """Whatever fails while the spool is emptied: the flight goes on, and all is stored once it no longer fails."""
    journal = await bench.open()
    flight = Flight(journal)
    await flight.begin()
    outage = Locked(bench, None)
    outage.begin()
    await flight.go_on(2)
    failed = 0

    def failing(self: Spool) -> None:
        nonlocal failed
        failed += 1
        if failed < 3:
            raise error
        clear(self)

    clear = Spool.clear
    monkeypatch.setattr(Spool, "clear", failing)
    outage.end()
    async with watched(journal):
        await flight.go_on(2)
        await until(journal, "ok")
        await flight.go_on(2)
    assert failed == 3
    assert journal.report().refused == 0
    await flight.check(await bench.open("other.spool"))


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
async def test_a_spooled_entry_that_always_fails_is_kept_aside_and_holds_up_nothing(bench, monkeypatch, tmp_path):
    monkeypatch.setattr(delivery, "RETRY_FIRST_S", 0.01)
    journal = await bench.open()
    flight = Flight(journal)
    await flight.begin()
    outage = Locked(bench, None)
    outage.begin()
    await flight.go_on(1)
    point = TrackPoint(1.7e9, 50.6, 7.2, 140.0, 40.0, 0.0, None, None)
    await journal.save_track("poisoned", "craft-1", [point])
    await flight.go_on(1)

    def written(self: TrackEntry, connection: object) -> None:
        if self.mission_id == "poisoned":
            raise ZeroDivisionError
        write(self, connection)  # type: ignore[arg-type]

    write = TrackEntry.write
    monkeypatch.setattr(TrackEntry, "write", written)
    outage.end()
    async with watched(journal):
        await until(journal, "ok")
    assert journal.report().refused == 1
    assert "poisoned" in (tmp_path / "journal.refused").read_text()
    await flight.check(await bench.open("other.spool"))


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
async def test_an_entry_of_the_spool_that_cannot_be_read_stops_no_start(bench, tmp_path):
    spool = Spool(tmp_path / "journal.spool", 64 * 1024)
    spool.append(b'{"entry": "of a later version", "fields": {}}')
    spool.close()
    journal = await bench.open()
    await journal.start_up()
    await Flight(journal).begin()
    assert journal.report().refused == 1
    assert "of a later version" in (tmp_path / "journal.refused").read_text()


WRITER = """
import asyncio, sys
from pathlib import Path
from backend.events import HoldOrdered
from backend.settings import Settings
from backend.store.opening import open_journal

async def main(folder, url):
    async with open_journal(Settings(data_dir=Path(folder), database_url=url), lambda: 1.7e9) as journal:
        while True:
            (record,) = await journal.append("m", [HoldOrdered(craft_id="craft-1", by="o", reason=None)])
            print(record.seq, flush=True)

asyncio.run(main(*sys.argv[1:]))
"""


async def test_what_was_acknowledged_survives_kill_9(bench, tmp_path):
    journal = await bench.open("first.spool")
    await journal.append("m", [DRAFT, STARTED])
    await bench.close()
    wait = random.Random(7)
    acknowledged = 2
    for _ in range(3):
        writer = await asyncio.create_subprocess_exec(
            sys.executable, "-c", WRITER, tmp_path, bench.url, stdout=subprocess.PIPE
        )
        acknowledged = int(await known(writer.stdout).readline())
        await asyncio.sleep(wait.uniform(0.0, 0.2))
        writer.kill()
        rest = (await known(writer.stdout).read()).split()
        await writer.wait()
        acknowledged = int(rest[-1]) if rest else acknowledged
        stored = await (await bench.open("check.spool")).read("m")
        await bench.close()
        assert [record.seq for record in stored] == list(range(1, len(stored) + 1))
        assert acknowledged <= len(stored) <= acknowledged + 1


@pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)
async def test_no_connection_to_a_database_that_hangs_is_closed_in_good_order(bench, postgres_cluster, monkeypatch):
    """For that SQLAlchemy waits two seconds more than the time that was set."""
    cut_off = []

    async def close(self, *, timeout=None):
        cut_off.append(self.is_closed())
        await in_good_order(self, timeout=timeout)

    in_good_order = asyncpg.Connection.close
    monkeypatch.setattr(asyncpg.Connection, "close", close)
    journal = await bench.open()
    await journal.append("m", [DRAFT])
    postgres_cluster.pause()
    try:
        await journal.append("m", [DRAFT])
    finally:
        postgres_cluster.resume()
    assert all(cut_off)


@pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)
async def test_a_server_ends_beside_a_database_that_hangs(bench, postgres_cluster):
    journal = await bench.open()
    await journal.append("m", [DRAFT])
    postgres_cluster.pause()
    try:
        async with asyncio.timeout(30.0):  # it would go on without end
            await bench.close()
    finally:
        postgres_cluster.resume()


@pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)
async def test_a_crowd_of_readers_keeps_no_fact_from_being_stored(bench):
    journal = await bench.open()
    await journal.append("m", [DRAFT])
    readers = [await journal._engine.connect() for _ in range(15)]  # all that a pool of its size gives
    try:
        await journal.append("m", [DRAFT])
        assert (journal.report().state, journal.report().spooled) == ("ok", 0)
    finally:
        for reader in readers:
            await reader.close()
