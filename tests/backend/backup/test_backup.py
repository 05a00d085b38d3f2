"""An archive of a server's data: whole, made while it writes, and put back on either database."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from facts import HOME, SPEC, bearing

from backend.api.beliefs import belief_frame
from backend.backup.making import make_backup
from backend.backup.manifest import BackupError
from backend.backup.restoring import AUDIT_BEFORE, restore
from backend.events import HoldOrdered, MissionDrafted, MissionEnded, MissionStarted, PhaseChanged
from backend.ports import TrackPoint
from backend.reasons.flight import Ordered
from backend.reasons.search import Localized
from backend.search.localization import localization
from backend.settings import AUDIT_FILE, Settings
from backend.store.entries import EventsEntry, to_row
from backend.store.journal import SqlJournal
from backend.store.opening import open_journal
from backend.store.retention import pack_paths
from backend.store.spool import Spool
from hardware.readings import Sweep

ENDED = MissionEnded(outcome="localized", reason=Localized(), mission_time_s=200.0)
DOWN = PhaseChanged(craft_id="craft-1", before="landing", after="ground", reason=Ordered("abort", "operator"))
STARTED = MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0")
BEARINGS = [bearing(number) for number in (1, 2, 3)]
TASK = localization(SPEC, HOME)
SWEEP = Sweep(
    np.array([10.0, 10.5, 11.0]), np.array([0.0, 15.0, 30.0]), np.array([-80.0, math.nan, -70.0]), 868e6, HOME, 140.0
)
POINTS = [TrackPoint(1.7e9 + n, 50.0 + n * 1e-5, 7.0, 140.0, 40.0, None, 80.0, "AUTO \U0001f681") for n in range(4)]
FILES = {
    "maps/0123.pmtiles": b"PMTiles\x03" + bytes(5000),
    "maps/0123.json": b"{}",
    "terrain/flown/ab": b"heights",
    "ways/flown.json": b"{}",
}


def hold(n: int) -> HoldOrdered:
    return HoldOrdered(craft_id="craft-1", by=str(n), reason=None)


async def write_mission(journal: SqlJournal) -> None:
    events = [MissionDrafted(spec=SPEC), STARTED]
    for number, fact in enumerate(BEARINGS, start=1):
        events += [fact, TASK.belief_fact(BEARINGS[:number])[0]]
    await journal.append("flown", events)
    await journal.append("a draft", [MissionDrafted(spec=SPEC.model_copy(update={"name": "ünter \x01 'quoted' \\"}))])
    await journal.save_sweep("flown", "s1", "craft-1", "emitter-1", 1, 1, SWEEP)
    await journal.save_track("flown", "craft-1", POINTS)
    await journal.append("over", [MissionDrafted(spec=SPEC), STARTED, ENDED, DOWN])
    await journal.save_track("over", "craft-1", POINTS)


async def told(journal: SqlJournal) -> list[object]:
    """Everything that can be read of it."""
    sweep = await journal.sweep("flown", "s1")
    recorded = await journal.read("flown")
    missions = await journal.missions()
    return [
        recorded,
        sweep,
        await journal.tracks("flown"),
        await journal.tracks("over"),
        missions,
        belief_frame("flown", recorded, False),
    ]


def served(tmp_path: Path, name: str, kind: str, request: pytest.FixtureRequest) -> Settings:
    url = None if kind == "sqlite" else request.getfixturevalue("postgres_cluster").new_database()
    return Settings(data_dir=tmp_path / name, database_url=url, spool_reserve_bytes=64 * 1024, disk_low_bytes=0)


@asynccontextmanager
async def opened(settings: Settings) -> AsyncIterator[SqlJournal]:
    async with open_journal(settings, lambda: 1.7e9) as journal:
        yield journal


@pytest.mark.parametrize("source", ["sqlite", "postgresql"])
@pytest.mark.parametrize("target", ["sqlite", "postgresql"])
async def test_what_was_saved_is_what_comes_back(tmp_path, request, source, target):
    here = await asyncio.to_thread(served, tmp_path, "here", source, request)
    there = await asyncio.to_thread(served, tmp_path, "there", target, request)
    for name, content in FILES.items():
        path = here.data_dir / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    pattern = tmp_path / "long yagi.json"
    pattern.write_text("{}")
    (here.data_dir / "maps" / ".upload-x.part").write_bytes(b"unfinished")
    here = here.model_copy(update={"antenna_pattern": pattern})
    async with opened(here) as journal:
        await write_mission(journal)
        before = await told(journal)
        assert await pack_paths(journal._engine, datetime.now(UTC)) == 1
        assert await told(journal) == before
        made = await asyncio.to_thread(make_backup, here, tmp_path / "b.zip")  # while the server runs
    assert made.gone == ()
    restored = await asyncio.to_thread(restore, there, tmp_path / "b.zip")
    async with opened(there) as journal:
        assert await told(journal) == before
        await journal.append("flown", [hold(1)])
    assert (restored.missions, restored.files) == (3, len(FILES) + 1)
    assert restored.pattern is not None
    assert restored.pattern.read_text() == "{}"
    kept = {p.relative_to(there.data_dir).as_posix(): p for p in there.data_dir.rglob("*") if p.is_file()}
    assert {name: kept[name].read_bytes() for name in FILES} == FILES
    assert not [name for name in kept if name.endswith(".part") or ".restoring" in name]


@pytest.mark.parametrize("kind", ["sqlite", "postgresql"])
async def test_a_backup_in_flight_holds_everything_acknowledged_before_and_no_gap(tmp_path, request, kind):
    here = await asyncio.to_thread(served, tmp_path, "here", kind, request)
    there = await asyncio.to_thread(served, tmp_path, "there", "sqlite", request)
    async with opened(here) as journal:
        await write_mission(journal)
        acknowledged = 0

        async def fly() -> None:
            nonlocal acknowledged
            for n in range(100_000):
                acknowledged = (await journal.append("flown", [hold(n)]))[0].seq

        flying = asyncio.create_task(fly())
        await asyncio.sleep(0.3)
        before = acknowledged
        await asyncio.to_thread(make_backup, here, tmp_path / "b.zip")
        after = acknowledged
        flying.cancel()
        await asyncio.gather(flying, return_exceptions=True)
    assert after > before, "the flight stood still meanwhile"
    await asyncio.to_thread(restore, there, tmp_path / "b.zip")
    async with opened(there) as journal:
        seqs = [record.seq for record in await journal.read("flown")]
    assert seqs == list(range(1, len(seqs) + 1))
    assert before <= len(seqs) <= after


async def test_what_waited_for_the_database_is_stored_by_the_next_start(tmp_path, request):
    here = served(tmp_path, "here", "sqlite", request)
    there = served(tmp_path, "there", "sqlite", request)
    async with opened(here) as journal:
        await write_mission(journal)
        count = len(await journal.read("flown"))
        at_utc = (await journal.read("flown"))[-1].at_utc
    spool = Spool(here.spool_path, 64 * 1024)
    spool.append(EventsEntry("flown", (to_row(count + 1, at_utc, hold(7)),)).encode())
    made = await asyncio.to_thread(make_backup, here, tmp_path / "b.zip")
    spool.close()
    assert made.manifest.members
    await asyncio.to_thread(restore, there, tmp_path / "b.zip")
    async with opened(there) as journal:
        assert (await journal.read("flown"))[-1].event == hold(7)
        assert journal.report().spooled == 0


async def test_a_server_that_has_only_started_takes_a_backup_and_keeps_its_own_audit_log(tmp_path, request):
    here, there = (served(tmp_path, name, "sqlite", request) for name in ("here", "there"))
    async with opened(here) as journal:
        await write_mission(journal)
        before = await told(journal)
    (here.data_dir / AUDIT_FILE).write_bytes(b"here\n")
    await asyncio.to_thread(make_backup, here, tmp_path / "b.zip")
    async with opened(there):
        (there.data_dir / AUDIT_FILE).write_bytes(b"there\n")
    await asyncio.to_thread(restore, there, tmp_path / "b.zip")
    async with opened(there) as journal:
        assert await told(journal) == before
    assert (there.data_dir / AUDIT_FILE).read_bytes() == b"here\n"
    assert (there.data_dir / AUDIT_BEFORE).read_bytes() == b"there\n"
    assert (there.data_dir / AUDIT_FILE).stat().st_mode & 0o077 == 0  # as the server makes it


async def test_a_target_that_holds_something_is_left_as_it_is(tmp_path, request):
    here, there = (served(tmp_path, name, "sqlite", request) for name in ("here", "there"))
    async with opened(here) as journal:
        await write_mission(journal)
        before = await told(journal)
    await asyncio.to_thread(make_backup, here, tmp_path / "b.zip")
    with pytest.raises(BackupError, match="database is not empty"):
        await asyncio.to_thread(restore, here, tmp_path / "b.zip")
    async with opened(here) as journal:
        assert await told(journal) == before
        with pytest.raises(BackupError, match="Another server uses"):
            await asyncio.to_thread(restore, here, tmp_path / "b.zip")
    (there.data_dir / "maps").mkdir(parents=True)
    (there.data_dir / "maps" / "1.json").write_text("{}")
    with pytest.raises(BackupError, match=r"not empty \(it holds maps/1.json\)"):
        await asyncio.to_thread(restore, there, tmp_path / "b.zip")


async def test_a_server_that_was_started_once_and_never_used_is_empty(tmp_path, request):
    here, there = (served(tmp_path, name, "sqlite", request) for name in ("here", "there"))
    async with opened(here) as journal:
        await write_mission(journal)
    async with opened(there):
        pass
    await asyncio.to_thread(make_backup, here, tmp_path / "b.zip")
    assert (await asyncio.to_thread(restore, there, tmp_path / "b.zip")).missions == 3


def test_there_must_be_a_database_and_room_for_the_archive(tmp_path):
    with pytest.raises(BackupError, match="there is no database"):
        make_backup(Settings(data_dir=tmp_path / "nothing"), tmp_path / "b.zip")
    assert not (tmp_path / "nothing").exists()


async def test_no_archive_is_overwritten_and_none_is_left_half_made(tmp_path, request, monkeypatch):
    here = served(tmp_path, "here", "sqlite", request)
    async with opened(here) as journal:
        await write_mission(journal)
    (tmp_path / "b.zip").write_text("another")
    with pytest.raises(BackupError, match="there already"):
        await asyncio.to_thread(make_backup, here, tmp_path / "b.zip")
    (here.data_dir / "maps").mkdir()
    (here.data_dir / "maps" / "broken").write_text("")

    def failing(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("backend.backup.making._copy", failing)
    with pytest.raises(BackupError, match="No space left"):
        await asyncio.to_thread(make_backup, here, tmp_path / "c.zip")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b.zip", "here"]
