"""Restores that go wrong half-way, by a full disk or by rows that nobody wrote: everything or nothing, in one line."""

from __future__ import annotations

import asyncio
import errno

import pytest
from archives import changed_row, packed, parts_of, refused, relisted
from facts import SPEC
from sqlalchemy import Connection, event, text
from sqlalchemy.ext.asyncio import AsyncEngine

from backend.backup import restoring
from backend.backup.making import make_backup
from backend.backup.manifest import BackupError
from backend.backup.restoring import AUDIT_BEFORE, restore
from backend.events import MissionDrafted
from backend.settings import AUDIT_FILE, Settings
from backend.store.engine import engine_for_once, migrate
from backend.store.opening import open_journal
from backend.store.reading import Wanted
from backend.store.spool import Spool, SpoolFull, entries_beside


@pytest.mark.parametrize("kind", ["oracle", "", None, ["sqlite"]])
def test_a_database_of_a_kind_that_nobody_knows_is_refused(sound, tmp_path, kind):
    assert "damaged (database" in refused(packed(relisted(parts_of(sound), database=kind)), tmp_path)


@pytest.mark.parametrize("name", ["files/own.sqlite", "files/own.sqlite-journal", "files/OWN.sqlite-wal"])
def test_no_part_takes_the_place_of_a_database_under_a_name_of_its_own(sound, tmp_path, name):
    """A journal beside it would be played back into it by SQLite itself."""
    archive, target = tmp_path / "a.zip", tmp_path / "target"
    archive.write_bytes(packed(relisted({**parts_of(sound), name: b"SQLite format 3\0 of somebody else"})))
    settings = Settings(data_dir=target, database_url=f"sqlite:///{target / 'own.sqlite'}", disk_low_bytes=0)
    with pytest.raises(BackupError, match="keeps its database"):
        restore(settings, archive)
    assert not target.exists()


@pytest.mark.parametrize("name", ["files/CROSSFIX.sqlite", "files/Journal.spool", "files/Logs/x"])
def test_capitals_make_no_other_name(sound, tmp_path, name):
    """The disks of some machines take them for the same file."""
    assert "no backup of Crossfix has" in refused(packed(relisted({**parts_of(sound), name: b"x"})), tmp_path)


@pytest.mark.parametrize(
    ("column", "value"),
    [("drafted_at_us", 10**30), ("name", "\ud800"), ("name", ["a list"]), ("flying", "perhaps"), ("last_seq", None)],
)
def test_a_value_that_no_database_holds_is_refused_in_one_line(sound, tmp_path, column, value):
    refused(packed(changed_row(parts_of(sound), "missions", column, value)), tmp_path)


@pytest.fixture(scope="module")
def older(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """Of a server before its library was searched: its facts are read when it is brought forward."""
    folder = tmp_path_factory.mktemp("older")
    here = Settings(data_dir=folder / "data", spool_reserve_bytes=64 * 1024, disk_low_bytes=0)
    asyncio.run(_older(here))
    make_backup(here, folder / "older.zip")
    return (folder / "older.zip").read_bytes()


async def _older(here: Settings) -> None:
    await migrate(here.async_database_url, revision="0005")
    body = MissionDrafted(spec=SPEC).model_dump_json()
    engine = engine_for_once(here.async_database_url, 60.0)
    async with engine.execution_options(write=True).begin() as connection:
        await connection.execute(text(OLDER_MISSION))
        await connection.execute(text(OLDER_EVENT), {"body": body})
    await engine.dispose()


OLDER_MISSION = """INSERT INTO missions (mission_id, name, phase, crafts, flying, drafted_at_us, emitters, bearings,
    rejected_sweeps, last_seq) VALUES ('m', 'Old', 'draft', '{}', 0, 1, 1, 0, 0, 1)"""
OLDER_EVENT = """INSERT INTO events (mission_id, seq, at_us, kind, form, body)
    VALUES ('m', 1, 1, 'mission_drafted', 3, :body)"""


def test_an_older_archive_is_brought_forward_on_a_server_that_has_started_too(older, tmp_path):
    (tmp_path / "a.zip").write_bytes(older)
    for name, started in (("new", False), ("started", True)):
        target = Settings(data_dir=tmp_path / name, spool_reserve_bytes=64 * 1024, disk_low_bytes=0)
        if started:
            asyncio.run(migrate(target.async_database_url))
        assert restore(target, tmp_path / "a.zip").missions == 1
        assert asyncio.run(_listed(target)) == ["Old"], "by what its facts tell of the emitter"


async def _listed(settings: Settings) -> list[str]:
    async with open_journal(settings, lambda: 1.7e9) as journal:
        wanted = Wanted(emitter=SPEC.emitters[0].emitter_id)
        return [digest.name for digest in await journal.page(10, wanted=wanted)]


@pytest.mark.parametrize(
    "body",
    ['{"kind": "mission_drafted", "spec": {"area": 7}}', "no json", '{"kind": "bearing_measured", "place": 7}', "[]"],
)
def test_facts_that_cannot_be_brought_forward_leave_no_row_and_no_file(older, tmp_path, body):
    hostile = changed_row(parts_of(older), "events", "body", body)
    said = refused(packed(relisted({**hostile, "files/maps/1.json": b"{}"})), tmp_path)
    assert "cannot be brought to today's schema" in said
    target = Settings(data_dir=tmp_path / "target" / "data", spool_reserve_bytes=64 * 1024, disk_low_bytes=0)
    (tmp_path / "sound.zip").write_bytes(older)
    assert restore(target, tmp_path / "sound.zip").missions == 1, "the target is as empty as before"


def full_for_files(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_fd: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(restoring.os, "fsync", full)


def full_for_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    """SQLite itself says so, as it does on a disk: the file may not grow."""

    def full(url: str, timeout_s: float) -> AsyncEngine:
        engine = engine_for_once(url, timeout_s)
        event.listen(engine.sync_engine, "connect", lambda raw, _: raw.execute("PRAGMA max_page_count = 1"))
        return engine

    monkeypatch.setattr(restoring, "engine_for_once", full)


def full_for_the_spool(monkeypatch: pytest.MonkeyPatch) -> None:
    append = Spool.append

    def full(spool: Spool, payload: bytes) -> None:
        if spool.entries():
            raise SpoolFull("No space left on device")
        append(spool, payload)

    monkeypatch.setattr(Spool, "append", full)


def full_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """When the rows are committed: files and spool are in their places already."""

    def full(url: str, timeout_s: float) -> AsyncEngine:
        engine = engine_for_once(url, timeout_s)

        @event.listens_for(engine.sync_engine, "commit")
        def refuse(connection: Connection) -> None:
            there = connection.exec_driver_sql("SELECT 1 FROM sqlite_master WHERE name = 'missions'").scalar()
            if there and connection.exec_driver_sql("SELECT count(*) FROM missions").scalar():
                raise OSError(errno.ENOSPC, "No space left on device")

        return engine

    monkeypatch.setattr(restoring, "engine_for_once", full)


@pytest.mark.parametrize("full", [full_for_files, full_for_rows, full_for_the_spool, full_at_the_end])
def test_a_disk_that_fills_leaves_a_target_as_empty_as_before(sound, tmp_path, full):
    waiting = parts_of(sound)["spool.jsonl"] + b'{"entry": "events", "of": "m"}\n' * 2
    parts = changed_row({**parts_of(sound), "spool.jsonl": waiting}, "missions", "notes", "x" * 200_000)
    archive = tmp_path / "a.zip"
    archive.write_bytes(packed(parts))
    target = Settings(data_dir=tmp_path / "target", spool_reserve_bytes=64 * 1024, disk_low_bytes=0)
    with pytest.MonkeyPatch.context() as patched:
        full(patched)
        with pytest.raises(BackupError, match=r"No space left|disk is full"):
            restore(target, archive)
    left = {path.name for path in target.data_dir.rglob("*") if path.is_file()}
    assert not {name for name in left if not name.startswith(("crossfix.sqlite", "journal.spool"))}, left
    assert entries_beside(target.spool_path) == []
    assert restore(target, archive).missions == 1
    assert len(entries_beside(target.spool_path)) == 2


def test_a_folder_that_cannot_be_made_is_said_in_one_line(sound, tmp_path):
    (tmp_path / "a.zip").write_bytes(sound)
    (tmp_path / "file").write_text("")
    with pytest.raises(BackupError, match="nothing can be written"):
        restore(Settings(data_dir=tmp_path / "file" / "data"), tmp_path / "a.zip")


def test_the_audit_log_of_a_restore_before_comes_back_beside_that_of_the_server(sound, tmp_path):
    logs = {f"files/{AUDIT_FILE}": b"saved\n", f"files/{AUDIT_BEFORE}": b"saved before\n"}
    (tmp_path / "a.zip").write_bytes(packed(relisted({**parts_of(sound), **logs})))
    target = Settings(data_dir=tmp_path / "target", spool_reserve_bytes=64 * 1024, disk_low_bytes=0)
    target.data_dir.mkdir()
    (target.data_dir / AUDIT_FILE).write_bytes(b"there\n")
    restore(target, tmp_path / "a.zip")
    kept = {path.name: path.read_bytes() for path in target.data_dir.glob("*audit*")}
    assert kept == {AUDIT_FILE: b"saved\n", AUDIT_BEFORE: b"saved before\n", f"another-{AUDIT_BEFORE}": b"there\n"}
