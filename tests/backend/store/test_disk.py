"""A disk that fills up, or that nothing may be written to any more, in flight."""

from __future__ import annotations

import asyncio
import sqlite3
import subprocess
from contextlib import suppress
from pathlib import Path

import pytest
from narrowing import known
from written_flight import Flight, until

from backend.reasons.storage import DiskLow, NothingStores
from backend.settings import Settings
from backend.store import delivery
from backend.store.opening import open_journal
from backend.store.reading import JournalUnavailable
from planner.reason import sentence_of


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
