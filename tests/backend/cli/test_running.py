"""A server hears the signal to end, however late its event loop is."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from backend.cli.running import STOPPING, stop_on_signals
from backend.mission.flights import LeftFlying

CALLS = 5_000
"""More than a loop's wakeup pipe takes before it is read."""


@pytest.fixture(autouse=True)
def handlers_of_before() -> Iterator[None]:
    before = {number: signal.getsignal(number) for number in STOPPING}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("number", STOPPING)
async def test_a_signal_is_heard_though_other_threads_called_more_than_a_late_loop_has_read(
    number: signal.Signals,
) -> None:
    left, stopped = list[float](), asyncio.Event()

    async def leave(patience_s: float) -> list[LeftFlying]:
        left.append(patience_s)
        return []

    flights = SimpleNamespace(leave=leave)
    running: Any = SimpleNamespace(
        services=SimpleNamespace(missions=SimpleNamespace(flights=flights)), stop=stopped.set
    )
    stop_on_signals(running, lambda _: None)
    loop = asyncio.get_running_loop()
    for _ in range(CALLS):
        loop.call_soon_threadsafe(int)
    os.kill(os.getpid(), number)
    async with asyncio.timeout(5):
        await stopped.wait()
    assert len(left) == 1
    assert {signal.getsignal(each) for each in STOPPING} == {signal.SIG_DFL}, "a second one ends it at once"


AFTER_ITS_LOOP = """
import asyncio, os, signal, sys
from backend.cli.running import stop_on_signals

async def serve():
    stop_on_signals(None, print)

asyncio.run(serve())
os.kill(os.getpid(), int(sys.argv[1]))
"""


@pytest.mark.parametrize("number", STOPPING)
def test_a_signal_after_the_loop_has_ended_ends_the_process_without_a_traceback(number: signal.Signals) -> None:
    command = [sys.executable, "-c", AFTER_ITS_LOOP, str(int(number))]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert (ended.returncode, ended.stderr) == (-number, "")
