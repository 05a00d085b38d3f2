"""The database goes away in flight: nothing waits long, nothing is lost, everything is stored exactly once."""

from __future__ import annotations

import asyncio
import os
import random
import sqlite3
import subprocess
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path

import numpy as np
import pytest
from narrowing import a, known
from sqlalchemy import make_url

from backend.events import HoldOrdered, MissionDrafted, MissionStarted
from backend.ports import TrackPoint
from backend.reasons.storage import DatabaseSilent, DatabaseTaken, DiskLow, NothingStores
from backend.settings import Settings
from backend.spec import MissionSpec, Polygon
from backend.store import delivery
from backend.store.entries import TrackEntry
from backend.store.journal import SqlJournal
from backend.store.opening import open_journal
from backend.store.reading import JournalUnavailable
from backend.store.spool import Spool
from hardware.readings import Place, Sweep
from planner.reason import sentence_of

SPEC = MissionSpec(name="s", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))
DRAFT = MissionDrafted(spec=SPEC)
HOME = Place(lat=50.6, lon=7.2)
STARTED = MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0")
SWEEP = Sweep(np.arange(3.0), np.arange(3.0), np.arange(3.0), 868e6, Place(50.6, 7.2), 140.0)


def hold(n: int) -> HoldOrdered:
    return HoldOrdered(craft_id="craft-1", by=str(n), reason=None)


@asynccontextmanager
async def watched(journal: SqlJournal) -> AsyncIterator[None]:
    task = asyncio.create_task(journal.run())
    yield
    task.cancel()
    with suppress(asyncio.CancelledError):
        await task


async def until(journal: SqlJournal, state: str) -> None:
    async with asyncio.timeout(30):
        while journal.report().state != state:  # noqa: ASYNC110 (the report is polled by its users too)
            await asyncio.sleep(0.02)


class Flight:
    """Writes what a flight writes, and knows what was acknowledged."""

    def __init__(self, journal: SqlJournal) -> None:
        self.journal = journal
        self.count = 0

    async def begin(self) -> None:
        await self.journal.append("m", [DRAFT, STARTED])

    async def go_on(self, steps: int) -> None:
        for _ in range(steps):
            n = self.count
            await self.journal.append("m", [hold(n)])
            await self.journal.save_sweep("m", f"s{n}", "craft-1", "emitter-1", 1, 1, SWEEP)
            point = TrackPoint(1.7e9 + n, 50.6, 7.2, 140.0, 40.0, 0.0, None, None)
            await self.journal.save_track("m", "craft-1", [point])
            self.count += 1

    async def check(self, stored: SqlJournal) -> None:
        read = await stored.read("m")
        assert [record.seq for record in read] == list(range(1, self.count + 3))
        assert [a(HoldOrdered, record.event).by for record in read[2:]] == [str(n) for n in range(self.count)]
        assert len((await stored.tracks("m"))["craft-1"]) == self.count
        for n in range(self.count):
            assert await stored.sweep("m", f"s{n}") is not None


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


@pytest.fixture
def small_disk(tmp_path: Path):
    """A file system of 2 MB of its own."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", folder], capture_output=True)
    if mounted.returncode:
        pytest.skip("a small file system cannot be mounted here: " + mounted.stderr.decode().strip())
    yield folder
    subprocess.run(["umount", "-l", folder], check=True)


async def test_a_full_disk_stops_nothing_and_spoils_nothing(small_disk):
    settings = Settings(data_dir=small_disk, spool_reserve_bytes=256 * 1024, disk_low_bytes=0)
    async with open_journal(settings, lambda: 1.7e9) as journal:
        flight = Flight(journal)
        await flight.begin()
        filler = small_disk / "filler"
        with suppress(OSError), filler.open("wb", buffering=0) as file:
            while True:
                file.write(bytes(4096))
        await flight.go_on(60)
        assert journal.report().state == "lost"
        assert "full" in sentence_of(known(journal.report().reason))
        with pytest.raises(JournalUnavailable, match="the disk is full"):
            await flight.go_on(1000)
        filler.unlink()
        await until(journal, "ok")
        filled = flight.count
    async with open_journal(settings, lambda: 1.7e9) as journal:
        read = await journal.read("m")
        assert [record.seq for record in read] == list(range(1, len(read) + 1))
        assert filled <= len(read) - 2 <= filled + 1
    assert sqlite3.connect(small_disk / "crossfix.sqlite").execute("PRAGMA integrity_check").fetchall() == [("ok",)]


@pytest.fixture
def forbidden(tmp_path: Path):
    """Forbids, or allows again, writing to what lies in a folder, as a disk that became read-only does. What SQLite has
    mapped into memory stays out: a process that writes there to a file that was forbidden is killed."""

    def forbid(sign: str) -> None:
        held = [path for path in tmp_path.iterdir() if not path.name.endswith("-shm")]
        done = subprocess.run(["chattr", sign, *map(str, held), str(tmp_path)], capture_output=True)
        if done.returncode:
            pytest.skip("files cannot be made immutable here: " + done.stderr.decode().strip())

    yield forbid
    forbid("-i")


async def test_files_that_cannot_be_written_any_more_are_said_and_stop_nothing(forbidden, tmp_path, caplog):
    async with open_journal(Settings(data_dir=tmp_path), lambda: 1.7e9) as journal:
        flight = Flight(journal)
        await flight.begin()
        await flight.go_on(2)
        forbidden("+i")
        for _ in range(3):
            with pytest.raises(JournalUnavailable, match="the spool cannot be written"):
                await flight.go_on(1)
            await asyncio.sleep(delivery.RETRY_FIRST_S)
            report = journal.report()
            assert (report.state, report.spooled) == ("lost", 0)
            assert isinstance(report.reason, NothingStores)
        assert len(await journal.read("m")) == 4, "what was stored is read"
        forbidden("-i")
        await until(journal, "ok")
        await flight.go_on(2)
    assert "did not foresee" not in caplog.text
    async with open_journal(Settings(data_dir=tmp_path), lambda: 1.7e9) as journal:
        await flight.check(journal)


async def test_a_disk_that_fills_up_is_told_before_it_is_full(tmp_path):
    async with open_journal(Settings(data_dir=tmp_path, disk_low_bytes=2**60), lambda: 1.7e9) as journal:
        await until(journal, "slow")
        assert isinstance(journal.report().reason, DiskLow)


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
