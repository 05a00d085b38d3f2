"""A mission room on doubles of its ports."""

from __future__ import annotations

from collections.abc import AsyncIterator

import pytest
from stage import Stage


@pytest.fixture
async def stage() -> AsyncIterator[Stage]:
    made = Stage()
    await made.room.start_up()
    yield made
    await made.room.shut_down()
