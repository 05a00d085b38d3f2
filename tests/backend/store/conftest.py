"""One journal fixture for both databases."""

from __future__ import annotations

from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from backend.settings import Settings
from backend.store.engine import make_engine, migrate
from backend.store.journal import SqlJournal
from backend.store.spool import Spool


@dataclass
class Bench:
    """Opens journals on one database and one spool, as restarts of one server do."""

    url: str
    folder: Path
    now_s: float = 1_700_000_000.0
    timeout_s: float = 1.0
    opened: list[SqlJournal] = field(default_factory=list)

    async def open(self, spool: str = "journal.spool") -> SqlJournal:
        engine = make_engine(self.url, self.timeout_s)
        kept = Spool(self.folder / spool, 256 * 1024)
        journal = SqlJournal(engine, kept, lambda: self.now_s, timeout_s=self.timeout_s)
        self.opened.append(journal)
        return journal

    async def close(self) -> None:
        for journal in self.opened:
            await journal.close()
        self.opened.clear()


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    if request.param == "sqlite":
        return Settings(data_dir=tmp_path).async_database_url
    return Settings(database_url=request.getfixturevalue("postgresql_url")).async_database_url


@pytest.fixture
async def bench(database_url: str, tmp_path: Path) -> AsyncIterator[Bench]:
    await migrate(database_url)
    opened = Bench(database_url, tmp_path)
    yield opened
    await opened.close()


@pytest.fixture
async def journal(bench: Bench) -> SqlJournal:
    return await bench.open()
