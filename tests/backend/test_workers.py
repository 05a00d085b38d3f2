"""Whatever a file makes its reader do, the event loop goes on and the next file is read."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import AsyncIterator
from pathlib import Path

import psutil
import pytest
from shapely import GEOSException

from backend.maps.refusal import MapRefused
from backend.reasons.maps import NothingToDraw
from backend.reasons.work import FileTooHeavy, ReadersBusy
from backend.workers import MOST_WAITING, Workers, WorkersBusy, WorkStopped


def _spin(seconds: float) -> None:
    """Holds its interpreter, as a bad pattern does."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        pass


def _fill(size: int) -> int:
    return len(bytearray(size))


def _keep(count: int) -> int:
    kept = [""]
    while len(kept) < count:
        kept.append(str(len(kept)))
    return len(kept)


def _nest(depth: int) -> int:
    return 1 if depth == 0 else 1 + _nest(depth - 1)


def _overrun_geometry() -> None:
    raise GEOSException("std::bad_alloc")


def _break_geometry() -> None:
    raise GEOSException("TopologyException: side location conflict")


def _die() -> None:
    os._exit(3)


def _refuse() -> None:
    raise MapRefused(NothingToDraw())


def _leave_word_and_spin(note: Path) -> None:
    note.write_text(str(os.getpid()))
    _spin(60)


@pytest.fixture
async def strict() -> AsyncIterator[Workers]:
    made = Workers(time_s=1.0, memory_bytes=200 * 2**20)
    yield made
    await made.close()


@pytest.mark.parametrize(
    ("work", "argument", "limit"),
    [(_spin, 60.0, "time"), (_fill, 400 * 2**20, "memory"), (_nest, 100_000, "depth"), (_die, None, "process")],
)
async def test_a_file_that_takes_too_much_is_stopped_and_the_next_is_read(
    strict: Workers, work, argument, limit
) -> None:
    """Only what takes too long meets a short limit: on a busy machine any of the others would, too."""
    strict.time_s = 1.0 if limit == "time" else 60.0
    with pytest.raises(WorkStopped) as stopped:
        await strict.run(work, *([] if argument is None else [argument]))
    assert stopped.value.reason == FileTooHeavy(limit, strict.time_s, 200 * 2**20)
    assert await strict.run(_fill, 1000) == 1000


async def test_geometry_that_takes_too_much_memory_is_too_heavy(strict: Workers) -> None:
    with pytest.raises(WorkStopped) as stopped:
        await strict.run(_overrun_geometry)
    assert stopped.value.reason == FileTooHeavy("memory", strict.time_s, strict.memory_bytes)
    with pytest.raises(GEOSException, match="side location"):
        await strict.run(_break_geometry)


async def test_a_file_that_takes_too_much_leaves_the_next_its_memory(strict: Workers) -> None:
    strict.time_s = 60.0
    with pytest.raises(WorkStopped):
        await strict.run(_keep, 6_000_000)
    assert await strict.run(_keep, 2_000_000) == 2_000_000


async def test_the_event_loop_goes_on_meanwhile(strict: Workers) -> None:
    await strict.run(_fill, 1)
    work = asyncio.create_task(strict.run(_spin, 0.8))
    turns = 0
    while not work.done():
        await asyncio.sleep(0.01)
        turns += 1
    assert turns > 8


async def test_what_the_work_refuses_reaches_the_caller(strict: Workers) -> None:
    with pytest.raises(MapRefused) as refused:
        await strict.run(_refuse)
    assert refused.value.reason == NothingToDraw()


async def test_a_crowd_is_told_to_come_again(strict: Workers) -> None:
    crowd = [asyncio.create_task(strict.run(_spin, 0.01)) for _ in range(MOST_WAITING)]
    await asyncio.sleep(0)
    with pytest.raises(WorkersBusy) as busy:
        await strict.run(_spin, 0.01)
    assert busy.value.reason == ReadersBusy(MOST_WAITING)
    await asyncio.gather(*crowd)


async def test_a_caller_that_goes_away_ends_the_work(tmp_path: Path) -> None:
    workers, note = Workers(time_s=60.0), tmp_path / "pid"
    work = asyncio.create_task(workers.run(_leave_word_and_spin, note))
    reader = await asyncio.to_thread(_reader_of, note)
    work.cancel()
    await asyncio.to_thread(reader.wait, 10)
    assert not reader.is_running()
    await workers.close()


def _reader_of(note: Path) -> psutil.Process:
    while not (note.exists() and note.read_text()):
        time.sleep(0.02)
    return psutil.Process(int(note.read_text()))
