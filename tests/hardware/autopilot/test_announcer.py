from __future__ import annotations

import asyncio

from hardware.autopilot.announcer import Announcer, Wakeup
from hardware.readings import Announcement
from hardware.reasons.vehicle_news import AutopilotRestarted


async def test_a_message_wakes_everybody_who_waits_and_only_then() -> None:
    wakeup = Wakeup()
    woken: list[str] = []

    async def wait(name: str) -> None:
        await wakeup.wait(5.0)
        woken.append(name)

    waiting = [asyncio.create_task(wait(name)) for name in ("a", "b")]
    await asyncio.sleep(0.01)
    assert woken == []
    wakeup.wake()
    await asyncio.gather(*waiting)
    assert sorted(woken) == ["a", "b"]


async def test_each_listener_hears_everything_and_one_that_sleeps_loses_the_oldest() -> None:
    announcer = Announcer(depth=3)
    awake, asleep = announcer.listen(), announcer.listen()
    said = [Announcement(float(at_s), AutopilotRestarted()) for at_s in range(5)]
    heard: list[Announcement | None] = []
    for announcement in said:
        announcer.say(announcement)
        heard.append(awake.get_nowait())
    announcer.end()

    assert heard == said
    assert [asleep.get_nowait() for _ in range(3)] == [said[3], said[4], None]
    announcer.forget(awake)
    announcer.say(said[0])
    assert awake.get_nowait() is None
    assert awake.empty()
