"""A database of people and an access over it, for all tests of accounts."""

from __future__ import annotations

from collections.abc import AsyncIterator
from pathlib import Path

import pytest
from entrance import Clocks, opened

from backend.auth.access import Access
from backend.store.engine import migrate


@pytest.fixture
def clocks() -> Clocks:
    return Clocks()


@pytest.fixture
async def url(tmp_path: Path) -> str:
    url = f"sqlite+aiosqlite:///{tmp_path / 'people.sqlite'}"
    await migrate(url)
    return url


@pytest.fixture
async def access(url: str, clocks: Clocks) -> AsyncIterator[Access]:
    access = opened(url, clocks)
    await access.load()
    yield access
    await access.close()
