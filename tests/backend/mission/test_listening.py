from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable

import pytest
from doubles import HummingReceiver

from backend.mission import listening as module
from backend.mission.listening import Listening
from hardware.clock import ScaledClock
from hardware.readings import PowerSample


def made() -> tuple[Listening, HummingReceiver, ScaledClock]:
    clock = ScaledClock(factor=50.0)
    receiver = HummingReceiver(clock)
    return Listening(receiver, clock, 868.3e6, silent_after_s=5.0), receiver, clock


async def until(happened: Callable[[], bool]) -> None:
    async with asyncio.timeout(10):
        while True:
            if happened():
                return
            await asyncio.sleep(0.002)


async def test_samples_of_an_interval_come_in_order() -> None:
    listening, _, clock = made()
    assert listening.state == "off"
    listening.start()
    assert await listening.first_sample(5.0)
    begin = clock.now()
    await clock.sleep(3.0)
    end = clock.now()
    await clock.sleep(1.0)
    found = listening.between(begin, end)
    assert found
    assert [s.at_s for s in found] == sorted(s.at_s for s in found)
    assert all(begin <= s.at_s <= end for s in found)
    assert listening.between(end + 100.0, end + 200.0) == []
    assert listening.state == "ok"
    await listening.stop()
    assert listening.state == "off"


async def test_samples_that_come_late_are_waited_for() -> None:
    listening, receiver, clock = made()
    due_s = clock.now() + 2.0

    async def late() -> AsyncIterator[PowerSample]:
        await clock.sleep(6.0)
        for k in range(5):
            yield PowerSample(due_s - 1.0 + 0.5 * k, 868.3e6, -60.0)
        await asyncio.Event().wait()

    receiver.samples = late  # type: ignore[method-assign]
    listening.start()
    async with asyncio.timeout(10):
        await listening.heard_until(due_s)
    assert [s.at_s for s in listening.between(due_s - 2.0, due_s)] == pytest.approx([due_s - 1.0, due_s - 0.5, due_s])
    await listening.stop()


async def test_a_silent_receiver_is_not_waited_for_longer_than_it_may_be_silent(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "LATE_WALL_S", 0.01)
    listening, receiver, clock = made()
    receiver.mute = True
    listening.start()
    began_s = clock.now()
    async with asyncio.timeout(10):
        await listening.heard_until(began_s)
    assert clock.now() - began_s >= 5.0
    assert listening.last is None
    await listening.stop()


async def test_a_receiver_with_a_backlog_without_end_keeps_nobody_waiting() -> None:
    listening, receiver, clock = made()

    async def flood() -> AsyncIterator[PowerSample]:
        while True:
            yield PowerSample(clock.now(), 868.3e6, -60.0)

    receiver.samples = flood  # type: ignore[method-assign]
    listening.start()
    async with asyncio.timeout(10):
        for _ in range(50):
            await asyncio.sleep(0)
    assert listening.last is not None
    await listening.stop()


async def test_silence_is_counted_in_time_that_was_watched() -> None:
    listening, receiver, _ = made()
    listening.start()
    assert await listening.first_sample(5.0)
    receiver.mute = True
    await asyncio.sleep(0.2)
    assert listening.state == "ok"
    for _ in range(6):
        listening.wait(1.0)
    assert listening.state == "silent"
    assert listening.trouble == "silent for 6 s"
    receiver.mute = False
    await until(lambda: listening.state == "ok")
    await listening.stop()


async def test_a_receiver_that_vanishes_is_lost_and_found_again() -> None:
    listening, receiver, _ = made()
    listening.start()
    assert await listening.first_sample(5.0)
    receiver.gone = True
    await until(lambda: listening.state == "lost")
    assert "unplugged" in listening.trouble
    receiver.gone = False
    await until(lambda: listening.state == "ok")
    await listening.stop()


async def test_a_mute_receiver_gives_no_first_sample() -> None:
    listening, receiver, _ = made()
    receiver.mute = True
    listening.start()
    assert not await listening.first_sample(0.1)
    await listening.stop()


async def test_a_receiver_that_hears_no_pulse_of_the_tag_is_well_and_has_heard_nothing() -> None:
    listening, receiver, _ = made()
    receiver.unheard = True
    listening.start()
    await until(lambda: listening.last is not None)
    assert not await listening.first_sample(0.05)
    assert listening.state == "ok"
    receiver.unheard = False
    assert await listening.first_sample(5.0)
    await listening.stop()
