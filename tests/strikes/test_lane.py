"""A lane of the proxy keeps what it carries in order."""

from __future__ import annotations

import asyncio
import time

from tests.strikes.lane import Lane


async def test_nothing_overtakes_what_is_under_way_when_the_delay_becomes_shorter() -> None:
    lane, arrived = Lane(), list[int]()

    for number in range(20):
        lane.put(lambda number=number: arrived.append(number), 0.1 if number < 10 else 0.0)
    assert arrived == []
    await asyncio.sleep(0.15)

    assert arrived == list(range(20))
    lane.put(lambda: arrived.append(20), 0.0)
    assert arrived[-1] == 20


async def test_what_fails_to_be_delivered_stops_nothing_behind_it() -> None:
    lane, arrived = Lane(), list[int]()
    asyncio.get_running_loop().set_exception_handler(lambda *_: None)

    def broken() -> None:
        raise OSError

    lane.put(broken, 0.01)
    lane.put(lambda: arrived.append(1), 0.01)
    await asyncio.sleep(0.05)

    assert arrived == [1]


async def test_all_that_became_due_while_the_process_was_busy_comes_at_once() -> None:
    lane, arrived = Lane(), list[int]()

    for number in range(100):
        lane.put(lambda number=number: arrived.append(number), 0.001)
    time.sleep(0.02)  # noqa: ASYNC251 (busy)
    for _ in range(3):
        await asyncio.sleep(0)

    assert arrived == list(range(100))
    assert lane.late_s >= 0.01
