"""A journal is opened by one server, on a database that is there, as often as one likes."""

from __future__ import annotations

import pytest

from backend.events import MissionDrafted
from backend.settings import Settings
from backend.spec import MissionSpec, Polygon
from backend.store import opening
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
