from __future__ import annotations

import sys
from collections.abc import AsyncIterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from console import Console, console

from backend.cli.running import RunningServer, running_server
from backend.settings import Settings

SPEEDUP = 12.0


@pytest.fixture
def flavour() -> str:
    return "px4"


@pytest.fixture
def speedup() -> float:
    return SPEEDUP


@pytest.fixture
async def server(tmp_path: Path, flavour: str, speedup: float) -> AsyncIterator[RunningServer]:
    """The real server on a free port, its SQLite file, and a simulated vehicle of its own process."""
    settings = Settings(
        port=0,
        data_dir=tmp_path,
        simulate=flavour,  # type: ignore[arg-type]
        simulated_flies_on=False,
        time_factor=speedup,
        seed=3,
    )
    async with running_server(settings) as running:
        yield running


@pytest.fixture
async def operator(server: RunningServer) -> AsyncIterator[Console]:
    """A drafted mission, preflight passed, the websocket open."""
    async with console(server.url) as made:
        await made.draft(planner={"seed": 3})
        await made.ready(120)  # on a busy machine its parameters take long to read
        await made.watch()
        yield made
