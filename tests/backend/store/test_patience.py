"""A slow database is kept apart from one that only this program kept waiting."""

from __future__ import annotations

import asyncio
import time

import pytest

from backend.store.patience import patience


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
