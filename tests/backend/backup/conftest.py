from __future__ import annotations

import asyncio

import pytest
from archives import sound_archive


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return asyncio.run(sound_archive(tmp_path_factory.mktemp("sound")))
