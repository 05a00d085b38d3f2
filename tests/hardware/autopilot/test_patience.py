from __future__ import annotations

import asyncio

import pytest

from hardware.autopilot.patience import Announcer, Deadline, News, Silence
from hardware.clock import ScaledClock


async def test_a_deadline_waits_for_the_slower_of_clock_and_wall() -> None:
    fast = ScaledClock(None, 1000.0)
    clock_only, floored = Deadline(fast, 5.0), Deadline(fast, 5.0, wall_floor_s=30.0)
    slow = Deadline(ScaledClock(None, 0.001), 5.0)

    await asyncio.sleep(0.03)

    assert clock_only.passed
    assert not floored.passed
    assert not slow.passed


def test_silence_is_what_was_looked_for_in_vain_and_a_program_that_stood_still_heard_nothing_wrong() -> None:
    silence = Silence()
    for _ in range(20):
        silence.look(0.1)
    assert silence.seconds == pytest.approx(2.0)
    silence.look(60.0)
    assert silence.seconds == pytest.approx(2.5)
    silence.heard()
    assert silence.seconds == 0.0
    silence.look(-1.0)
    assert silence.seconds == 0.0


async def test_news_wakes_everybody_who_waits_and_only_then() -> None:
    news, woken = News(), []

    async def wait(name: str) -> None:
        await news.wait(5.0)
        woken.append(name)

    waiting = [asyncio.create_task(wait(name)) for name in ("a", "b")]
    await asyncio.sleep(0.01)
    assert woken == []
    news.tell()
    await asyncio.gather(*waiting)
    assert sorted(woken) == ["a", "b"]


async def test_each_listener_hears_every_line_and_one_that_sleeps_loses_the_oldest() -> None:
    announcer = Announcer(depth=3)
    awake, asleep = announcer.listen(), announcer.listen()
    heard = []
    for line in "abcde":
        announcer.say(line)
        heard.append(awake.get_nowait())
    announcer.end()

    assert heard == list("abcde")
    assert [asleep.get_nowait() for _ in range(3)] == ["d", "e", None]
    announcer.forget(awake)
    announcer.say("f")
    assert awake.get_nowait() is None
    assert awake.empty()
