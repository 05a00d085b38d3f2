"""Makes the shared mission scripts importable under pytest's importlib mode, and a service on doubles of its ports."""

from __future__ import annotations

import sys
from collections.abc import AsyncIterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from doubles import Stage


@pytest.fixture
async def stage() -> AsyncIterator[Stage]:
    made = Stage()
    await made.service.start_up()
    yield made
    await made.service.shut_down()
