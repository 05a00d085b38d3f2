"""What is damaged in the database is the trouble of one mission: it says so, and the others are read as ever."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable
from datetime import UTC, datetime, timedelta

import pytest
from facts import HOME, SPEC
from sqlalchemy import text

from backend.backup.making import make_backup
from backend.backup.restoring import restore
from backend.events import MissionDeleted, MissionDrafted, MissionEdited, MissionRestored, NetsNoted
from backend.ports import FactRefused, JournalDamaged, TrackPoint
from backend.reasons.storage import DatabaseLater, MissionDamaged
from backend.settings import Settings
from backend.spec import Polygon
from backend.store import entries
from backend.store.engine import make_engine
from backend.store.journal import SqlJournal
from backend.store.opening import DatabaseUnusable, open_journal
from backend.store.packed import MARK
from backend.store.reading import Wanted
from backend.store.retention import bury
from backend.store.tables import paths
from hardware.fence import Nets

PATIENCE_S = 60.0
RING = [(HOME.lon, HOME.lat), *((HOME.lon + 0.01, HOME.lat + n / 1e4) for n in range(60)), (HOME.lon, HOME.lat)]
LONG_FACT = MissionEdited(spec=SPEC.model_copy(update={"area": Polygon(coordinates=[RING])}))
NETS = NetsNoted(craft_id="craft-1", before=Nets((), ()), after=Nets((), ()))
POINT = TrackPoint(1.7e9, 50.0, 7.0, 140.0, 40.0, None, 80.0, "HOLD")


async def struck(url: str, statement: str, **values: object) -> None:
    engine = make_engine(url, PATIENCE_S)
    async with engine.execution_options(write=True).begin() as connection:
        await connection.execute(text(statement), values)
    await engine.dispose()


async def damage(url: str, mission_id: str, seq: int) -> None:
    body = b"\x78\x9c no text" if url.startswith("sqlite") else f"{MARK}AAAA"
    where = "WHERE mission_id = :mission_id AND seq = :seq"
    await struck(url, f"UPDATE events SET body = :body {where}", body=body, mission_id=mission_id, seq=seq)


async def write(journal: SqlJournal) -> None:
    for mission_id in ("bad", "good"):
        await journal.append(mission_id, [MissionDrafted(spec=SPEC), LONG_FACT, NETS])
        await journal.save_track(mission_id, "craft-1", [POINT])


READS: list[Callable[[SqlJournal, str], Awaitable[object]]] = [
    SqlJournal.read,
    SqlJournal.read_texts,
    SqlJournal.tracks,
    lambda journal, mission_id: journal.read_kinds(mission_id, ["mission_edited"]),
]


@pytest.mark.parametrize("read", READS, ids=["facts", "texts", "paths", "kinds"])
async def test_one_mission_says_that_it_is_damaged_and_the_list_and_the_others_are_there(bench, read) -> None:
    bench.timeout_s = PATIENCE_S
    await write(await bench.open())
    await damage(bench.url, "bad", 2)
    engine = make_engine(bench.url, PATIENCE_S)
    async with engine.execution_options(write=True).begin() as connection:
        row = {"mission_id": "bad", "craft_id": "craft-1", "at_us": 1, "points": b"no piece"}
        await connection.execute(paths.insert().values(row))
    await engine.dispose()
    journal = await bench.open("other.spool")
    with pytest.raises(JournalDamaged) as damaged:
        await read(journal, "bad")
    assert isinstance(damaged.value.reason, MissionDamaged)
    assert damaged.value.reason.mission_id == "bad"
    assert await read(journal, "good")
    assert {digest.mission_id for digest in await journal.page(10)} == {"bad", "good"}


async def test_nets_are_owed_though_another_mission_is_damaged(bench) -> None:
    """Asked at a start: the server would not come back to what flies."""
    bench.timeout_s = PATIENCE_S
    await write(await bench.open())
    await damage(bench.url, "bad", 3)
    journal = await bench.open("other.spool")
    assert [record.mission_id for record in await journal.of_nets()] == ["good"]


async def test_a_damaged_mission_takes_what_needs_none_of_its_facts(bench) -> None:
    bench.timeout_s = PATIENCE_S
    await write(await bench.open())
    await damage(bench.url, "bad", 2)
    journal = await bench.open("other.spool")
    with pytest.raises(JournalDamaged):
        await journal.append("bad", [MissionDeleted(by="anna")])
    (deleted,) = await journal.append_unread("bad", [MissionDeleted(by="anna")])
    assert deleted.seq == 4
    listed = await journal.listed("bad")
    assert listed is not None
    assert listed.deleted
    assert {digest.mission_id for digest in await journal.page(10)} == {"good"}
    assert {digest.mission_id for digest in await journal.page(10, wanted=Wanted(deleted=True))} == {"bad"}
    assert (await journal.append_unread("bad", [MissionRestored(by="ben")]))[0].seq == 5
    assert {digest.mission_id for digest in await journal.page(10)} == {"bad", "good"}
    engine = make_engine(bench.url, PATIENCE_S)
    await journal.append_unread("bad", [MissionDeleted(by="anna")])
    assert await bury(engine, 30.0, datetime.now(UTC) + timedelta(days=40)) == 1, "gone like any other"
    await engine.dispose()
    assert await journal.read("bad") == []
    with pytest.raises(FactRefused, match="there is no mission"):
        await journal.append_unread("bad", [MissionRestored(by="ben")])


async def test_a_text_that_is_no_fact_is_damage_too(bench) -> None:
    bench.timeout_s = PATIENCE_S
    await write(await bench.open())
    await struck(bench.url, "UPDATE events SET body = '{}' WHERE mission_id = 'bad' AND seq = 3")
    with pytest.raises(JournalDamaged):
        await (await bench.open("other.spool")).read("bad")


async def test_a_fact_too_long_to_be_read_again_is_refused(bench, monkeypatch: pytest.MonkeyPatch) -> None:
    bench.timeout_s = PATIENCE_S
    journal = await bench.open()
    monkeypatch.setattr(entries, "MOST_BYTES", 4000)
    with pytest.raises(FactRefused, match="longer than any"):
        await journal.append("m", [MissionDrafted(spec=LONG_FACT.spec.model_copy(update={"name": "x" * 5000}))])
    assert await journal.append("m", [MissionDrafted(spec=SPEC)])


async def test_a_backup_holds_all_but_what_is_damaged(tmp_path, caplog: pytest.LogCaptureFixture) -> None:
    here, there = (Settings(data_dir=tmp_path / name, spool_reserve_bytes=64 * 1024) for name in ("here", "there"))
    async with open_journal(here, lambda: 1.7e9) as journal:
        await write(journal)
        good = await journal.read("good")
    await damage(here.async_database_url, "bad", 2)
    with caplog.at_level(logging.ERROR):
        await asyncio.to_thread(make_backup, here, tmp_path / "b.zip")
    assert "event 2 of mission bad" in caplog.text
    await asyncio.to_thread(restore, there, tmp_path / "b.zip")
    async with open_journal(there, lambda: 1.7e9) as journal:
        assert await journal.read("good") == good
        for read in (journal.read, journal.read_texts):
            with pytest.raises(JournalDamaged):
                await read("bad")


async def test_a_database_of_a_later_version_is_refused_by_name_and_left_as_it_is(tmp_path) -> None:
    here = Settings(data_dir=tmp_path, spool_reserve_bytes=64 * 1024)
    async with open_journal(here, lambda: 1.7e9) as journal:
        await write(journal)
    await struck(here.async_database_url, "UPDATE alembic_version SET version_num = '0999'")
    with pytest.raises(DatabaseUnusable) as refused:
        async with open_journal(here, lambda: 1.7e9):
            pass
    assert isinstance(refused.value.reason, DatabaseLater)
    assert refused.value.reason.revision == "0999"
