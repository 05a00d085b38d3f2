"""A journal is opened by one server, on a database that is there, as often as one likes."""

from __future__ import annotations

import asyncio
from uuid import uuid4

import pytest

from backend.events import MissionDrafted
from backend.ports import FactRefused
from backend.settings import Settings
from backend.spec import MissionSpec, Polygon
from backend.store import engine, opening
from backend.store.engine import migrate
from backend.store.opening import DatabaseUnusable, open_journal
from planner.reason import remedy_of

SPEC = MissionSpec(name="s", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))
DRAFT = MissionDrafted(spec=SPEC)


async def test_migrating_again_changes_nothing(bench):
    journal = await bench.open()
    written = await journal.append("m", [DRAFT])
    await migrate(bench.url)
    await migrate(bench.url)
    assert await (await bench.open("other.spool")).read("m") == written


async def test_nobody_else_reads_a_new_database_file(tmp_path):
    async with open_journal(Settings(data_dir=tmp_path), lambda: 0.0):
        kept = [path for path in tmp_path.iterdir() if path.suffix != ".server"]
        assert [path.name for path in kept if path.stat().st_mode & 0o077] == []


async def test_a_second_server_on_the_same_database_or_data_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(opening, "CLAIM_PATIENCE_S", 0.1)
    settings = Settings(data_dir=tmp_path / "one")
    beside = Settings(data_dir=tmp_path / "two", database_url=f"sqlite:///{tmp_path / 'one' / 'crossfix.sqlite'}")
    same_data = Settings(data_dir=tmp_path / "one", database_url=f"sqlite:///{tmp_path / 'other.sqlite'}")
    async with open_journal(settings, lambda: 0.0):
        for second in (settings, beside, same_data):
            with pytest.raises(DatabaseUnusable) as refused:
                async with open_journal(second, lambda: 0.0):
                    pass
            assert "--data-dir" in remedy_of(refused.value.reason)
    async with open_journal(beside, lambda: 0.0):
        pass


@pytest.mark.parametrize("url", ["postgresql://nobody@127.0.0.1:1/none", "sqlite:////proc/none/x.sqlite"])
async def test_a_database_that_cannot_be_used_is_named_with_what_to_try(tmp_path, url):
    with pytest.raises(DatabaseUnusable) as refused:
        async with open_journal(Settings(data_dir=tmp_path, database_url=url), lambda: 0.0):
            pass
    assert "CROSSFIX_DATABASE_URL" in remedy_of(refused.value.reason)


async def test_a_start_says_early_that_it_waits_for_the_database(tmp_path, caplog):
    async def hang_up(_reader, writer):
        await asyncio.sleep(0.6)
        writer.close()

    silent = await asyncio.start_server(hang_up, "127.0.0.1", 0)
    port = silent.sockets[0].getsockname()[1]
    url = f"postgresql://crossfix:secret@127.0.0.1:{port}/x"
    settings = Settings(data_dir=tmp_path, database_url=url, database_timeout_s=0.2)
    with pytest.raises(DatabaseUnusable):
        async with open_journal(settings, lambda: 0.0):
            pass
    silent.close()
    assert f"127.0.0.1:{port}/x" in caplog.text
    assert "secret" not in caplog.text


@pytest.fixture
def narrow_url(postgres_cluster):
    """A database that has no letters but those of western Europe."""
    name = f"narrow_{uuid4().hex[:12]}"
    made = f"CREATE DATABASE {name} ENCODING 'LATIN1' TEMPLATE template0 LOCALE 'C'"
    asyncio.run(postgres_cluster._ask(made))
    return postgres_cluster.url(name)


async def test_a_new_database_that_lacks_letters_is_refused(tmp_path, narrow_url):
    with pytest.raises(DatabaseUnusable, match="LATIN1"):
        async with open_journal(Settings(data_dir=tmp_path, database_url=narrow_url), lambda: 0.0):
            pass


async def test_a_fact_whose_letters_an_older_database_lacks_holds_up_nothing(tmp_path, narrow_url, monkeypatch):
    monkeypatch.setattr(engine, "_require_unicode", lambda _: None)
    async with open_journal(Settings(data_dir=tmp_path, database_url=narrow_url), lambda: 0.0) as journal:
        await journal.append("m", [DRAFT])
        with pytest.raises(FactRefused, match="LATIN1"):
            await journal.append("m", [MissionDrafted(spec=SPEC.model_copy(update={"name": "\U0001f98a"}))])
        assert (journal.report().state, journal.report().spooled) == ("ok", 0)
        (after,) = await journal.append("m", [DRAFT])
        assert after.seq == 2
