"""Raw sweeps go by rule: those of missions that are long over, and nothing else."""

from __future__ import annotations

import asyncio
from datetime import UTC, date, datetime, timedelta

import numpy as np
import pytest
from facts import HOME, SPEC
from sqlalchemy import make_url, select
from typer.testing import CliRunner

from backend.cli.main import app
from backend.events import MissionDeleted, MissionDrafted, MissionEnded, MissionStarted, Phase, PhaseChanged
from backend.reasons.flight import Ordered
from backend.reasons.search import Localized
from backend.store import retention
from backend.store.days_seen import DaysSeen
from backend.store.engine import engine_for_once
from backend.store.iq_folder import IqFolder
from backend.store.retention import old_sweeps, thin
from backend.store.tables import missions
from backend.store.told_folder import ToldFolder
from backend.store.ways_files import WaysFiles
from hardware.readings import Sweep

DRAFT = MissionDrafted(spec=SPEC)
STARTED = MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0")
SWEEP = Sweep(np.arange(3.0), np.arange(3.0), np.arange(3.0), 868e6, HOME, 140.0)
NOW = datetime(2026, 6, 1, tzinfo=UTC)
ENDED = MissionEnded(outcome="localized", reason=Localized(), mission_time_s=200.0)


def craft(before: Phase, after: Phase) -> PhaseChanged:
    reason = Ordered("abort", "operator")
    return PhaseChanged(craft_id="craft-1", before=before, after=after, reason=reason)


STORIES = {
    "draft": [DRAFT],
    "flying": [DRAFT, STARTED],
    "on its way home": [DRAFT, STARTED, craft("ground", "returning"), ENDED],
    "over": [DRAFT, STARTED, craft("ground", "returning"), ENDED, craft("returning", "ground")],
}


async def fill(bench, days_ago: float, suffix: str = "") -> list[str]:
    bench.now_s = (NOW - timedelta(days=days_ago)).timestamp()
    journal = await bench.open(f"{days_ago}.spool")
    for name, events in STORIES.items():
        await journal.append(name + suffix, events)
        for n in range(60):
            await journal.save_sweep(name + suffix, f"s{n}", "craft-1", "emitter-1", 1, 1, SWEEP)
    return [name + suffix for name in STORIES]


async def left(bench, missions: list[str]) -> set[str]:
    journal = await bench.open(f"{len(bench.opened)}.read.spool")
    return {name for name in missions for n in (0, 59) if await journal.sweep(name, f"s{n}") is not None}


async def test_only_missions_long_over_lose_their_samples(bench):
    old, new = await fill(bench, 400.0), await fill(bench, 3.0, " lately")
    engine = engine_for_once(bench.url, 5.0)
    try:
        would = await old_sweeps(engine, 365.0, NOW)
        assert await left(bench, old + new) == {*old, *new}
        assert await thin(engine, 365.0, NOW) == would
        assert (would.missions, would.sweeps) == (1, 60)
        assert would.size_bytes > 60 * 20
        assert (await old_sweeps(engine, 365.0, NOW)).sweeps == 0
    finally:
        await engine.dispose()
    assert await left(bench, old + new) == {*old, *new} - {"over"}
    journal = await bench.open("after.spool")
    assert [record.event for record in await journal.read("over")] == STORIES["over"]


async def test_a_chore_that_fails_keeps_none_of_the_others_from_its_turn(bench, tmp_path, monkeypatch):
    await fill(bench, 400.0)

    async def failing(*_: object) -> int:
        raise OverflowError("a path that nobody foresaw")

    for name in ("bury", "pack_paths", "thin_iq"):
        monkeypatch.setattr(retention, name, failing)
    monkeypatch.setattr(retention, "FIRST_AFTER_S", 0.0)
    engine = engine_for_once(bench.url, 60.0)
    others = ToldFolder(tmp_path / "told"), WaysFiles(tmp_path / "ways")
    old = DaysSeen(tmp_path / "old.json")
    old.file.write_text(f'{{"over": [30, "{datetime.now(UTC).date()}"]}}')
    seen = DaysSeen(tmp_path / "deleted.json"), old
    keeping = asyncio.create_task(retention.keep_thin(engine, 30.0, seen, IqFolder(tmp_path / "iq"), *others))
    async with asyncio.timeout(60):
        while (await old_sweeps(engine, 30.0, datetime.now(UTC))).sweeps:  # noqa: ASYNC110 (it says nothing)
            await asyncio.sleep(0.05)
    assert not keeping.done(), "it goes on after what failed"
    keeping.cancel()
    await asyncio.gather(keeping, return_exceptions=True)
    await engine.dispose()


async def test_a_clock_that_was_set_ahead_buries_nothing(bench, tmp_path):
    """Deleted yesterday; then the clock says 2036, the server runs on, and the clock is put right again."""
    journal = await bench.open()
    bench.now_s = NOW.timestamp()
    await journal.append("deleted", [DRAFT, MissionDeleted(by="operator")])
    days = DaysSeen(tmp_path / "deleted.json")
    engine = engine_for_once(bench.url, 5.0)

    async def runs_on(*when: datetime) -> bool:
        """Is the mission there after these days?"""
        for now in when:
            await retention._bury(days, engine, now)
            await retention._bury(days, engine, now + timedelta(hours=1))
        async with engine.connect() as connection:
            return (await connection.execute(select(missions.c.mission_id))).first() is not None

    try:
        ahead = datetime(2036, 6, 1, tzinfo=UTC)
        assert await runs_on(NOW + timedelta(days=1), *(ahead + timedelta(days=day) for day in range(5)))
        assert await runs_on(*(NOW + timedelta(days=day) for day in range(2, 26)))
        assert await runs_on(NOW + timedelta(days=29.9)), "the right clock's thirty days count as well"
        assert not await runs_on(NOW + timedelta(days=31))
    finally:
        await engine.dispose()


async def test_a_clock_that_was_set_ahead_takes_no_raw_sweeps(bench, tmp_path):
    """Over since yesterday; then the clock says 2036, the server runs on, and the clock is put right again."""
    await fill(bench, 1.0)
    days, iq = DaysSeen(tmp_path / "old.json"), IqFolder(tmp_path / "iq")
    engine = engine_for_once(bench.url, 5.0)

    async def runs_on(*when: datetime) -> int:
        """Sweeps of the mission that is over, after these days."""
        for now in when:
            await retention._take_sweeps(365.0, days, iq, engine, now)
            await retention._take_sweeps(365.0, days, iq, engine, now + timedelta(hours=1))
        return (await old_sweeps(engine, 0.0, NOW)).sweeps

    try:
        ahead = datetime(2036, 6, 1, tzinfo=UTC)
        assert await runs_on(*(ahead + timedelta(days=day) for day in range(29))) == 60
        assert await runs_on(*(NOW + timedelta(days=day) for day in range(2, 364, 7))) == 60
        later = [NOW + timedelta(days=365 + day) for day in range(31)]
        assert await runs_on(*later[:-1]) == 60, "it was not old in between: the days are counted from the start"
        assert await runs_on(later[-1]) == 0
    finally:
        await engine.dispose()


async def test_a_rule_of_fewer_days_waits_for_no_more_than_these(bench, tmp_path):
    await fill(bench, 400.0)
    days, iq = DaysSeen(tmp_path / "old.json"), IqFolder(tmp_path / "iq")
    engine = engine_for_once(bench.url, 5.0)
    try:
        for day, left_over in enumerate((60, 60, 0)):
            await retention._take_sweeps(2.0, days, iq, engine, NOW + timedelta(days=day))
            assert (await old_sweeps(engine, 2.0, NOW)).sweeps == left_over
        await retention._take_sweeps(0.0, days, iq, engine, NOW)
    finally:
        await engine.dispose()


def test_days_count_once_each_and_begin_anew_when_a_mission_was_restored(tmp_path, caplog):
    days, first = DaysSeen(tmp_path / "deleted.json"), date(2026, 6, 1)
    assert [days.count(["a"], first) for _ in range(3)] == [{"a": 0}] * 3
    assert days.count(["a", "b"], first + timedelta(days=9)) == {"a": 1, "b": 0}
    assert days.count(["b"], first + timedelta(days=10)) == {"b": 1}
    assert days.count(["a", "b"], first + timedelta(days=11)) == {"a": 0, "b": 2}
    days.file.write_bytes(b"[" * 100_000)
    assert days.count(["b"], first) == {"b": 0}
    assert "cannot be read" in caplog.text


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
async def test_the_command_takes_them_and_the_file_shrinks(bench, tmp_path):
    wide = np.random.default_rng(1).normal(size=4000)
    journal = await bench.open()
    bench.now_s = (datetime.now(UTC) - timedelta(days=20)).timestamp()
    await journal.append("over", STORIES["over"])
    for n in range(20):
        sweep = type(SWEEP)(wide, wide, wide, 868e6, SWEEP.position, 140.0)
        await journal.save_sweep("over", f"s{n}", "craft-1", "emitter-1", 1, 1, sweep)
    await bench.close()
    file = tmp_path / "crossfix.sqlite"
    assert str(file) == make_url(bench.url).database
    before = file.stat().st_size

    def crossfix(*more: str) -> str:
        result = CliRunner().invoke(app, ["thin", "--data-dir", str(tmp_path), *more])
        return f"{result.exit_code} {result.output}"

    assert (await asyncio.to_thread(crossfix)).startswith("2 crossfix: for how many days")
    assert "0 would take 20 raw sweeps of 1 missions" in await asyncio.to_thread(
        crossfix, "--keep-days", "10", "--dry-run"
    )
    assert "0 took 20 raw sweeps" in await asyncio.to_thread(crossfix, "--keep-days", "10")
    assert file.stat().st_size < before / 4
