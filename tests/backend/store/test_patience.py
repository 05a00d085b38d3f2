"""A slow database is kept apart from one that only this program kept waiting."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from backend.store import patience as waiting
from backend.store.patience import CrowdedError, StarvedError, patience


async def test_a_silence_ends_it() -> None:
    with pytest.raises(TimeoutError):
        async with patience(0.2):
            await asyncio.Event().wait()


async def test_an_answer_that_came_while_this_program_stood_still_counts() -> None:
    answered = asyncio.Event()
    loop = asyncio.get_running_loop()

    async def stand_still() -> None:
        await asyncio.sleep(0.05)
        loop.call_later(0.3, answered.set)
        time.sleep(1.0)  # noqa: ASYNC251 (a busy machine)

    standing = asyncio.create_task(stand_still())
    async with patience(0.5):
        await answered.wait()
    assert answered.is_set()
    await standing


async def test_nothing_is_left_over_once_it_is_answered() -> None:
    async with patience(0.15):
        pass
    await asyncio.sleep(0.3)
    this = asyncio.current_task()
    assert this is not None
    assert this.cancelling() == 0
    assert asyncio.all_tasks() == {this}


async def test_a_silence_while_our_threads_are_heard_is_the_others_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(waiting, "PROMPT_SHARE", 0.1)  # the machine of the tests may be busy itself
    with pytest.raises(TimeoutError) as silent:
        async with patience(2.0):
            await asyncio.Event().wait()
    assert not isinstance(silent.value, StarvedError)


async def test_a_silence_while_no_thread_of_ours_gets_its_turn_proves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """As on a machine that is busy with other things: an idle thread is heard from as late as the database's."""
    monkeypatch.setattr(waiting, "_nothing", lambda: time.sleep(0.5))
    with pytest.raises(StarvedError):
        async with patience(0.6):
            await asyncio.Event().wait()


def told(monkeypatch: pytest.MonkeyPatch, cpu_s: Iterator[float], io_s: Iterator[float]) -> None:
    """As if the kernel told of these waits, one after another."""

    class Pressure:
        def __init__(self, waits: Iterator[float]) -> None:
            self._waits = waits

        def read_text(self) -> str:
            return f"some avg10=9.00 avg60=9.00 avg300=9.00 total={1e6 * next(self._waits):.0f}\nfull total=0\n"

    files = {"cpu": Pressure(cpu_s), "io": Pressure(io_s)}
    monkeypatch.setattr(waiting, "PRESSURE", type("Folder", (), {"__truediv__": lambda _, name: files[name]})())
    monkeypatch.setattr(waiting, "PROMPT_SHARE", 0.0)


@pytest.mark.parametrize(
    ("cpu_s", "io_s", "crowded"),
    [((70.0, 70.9), (5.0, 5.01), True), ((70.0, 70.9), (5.0, 5.9), False), ((70.0, 70.1), (5.0, 5.01), False)],
)
async def test_the_kernel_is_asked_whether_a_processor_or_the_disk_was_waited_for(
    monkeypatch: pytest.MonkeyPatch, cpu_s: tuple[float, float], io_s: tuple[float, float], crowded: bool
) -> None:
    told(monkeypatch, iter(cpu_s), iter(io_s))
    with pytest.raises(TimeoutError) as silent:
        async with patience(0.3):
            await asyncio.Event().wait()
    assert isinstance(silent.value, CrowdedError) == crowded


async def test_a_system_that_tells_nothing_of_its_waits_changes_nothing(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(waiting, "PRESSURE", tmp_path)
    monkeypatch.setattr(waiting, "PROMPT_SHARE", 0.0)
    with pytest.raises(TimeoutError) as silent:
        async with patience(0.3):
            await asyncio.Event().wait()
    assert type(silent.value) is TimeoutError


async def test_an_own_time_limit_inside_is_nobodys_silence() -> None:
    with pytest.raises(TimeoutError) as own:
        async with patience(5.0):
            raise TimeoutError("its own")
    assert not isinstance(own.value, StarvedError)
