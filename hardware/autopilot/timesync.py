"""MAVLink TIMESYNC: ask the autopilot for its time since boot, again and again, and time the answers."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable

from hardware.autopilot.link import Fields, MavlinkLink
from hardware.ports import Clock

EVERY_WALL_S = 0.2
"""280 bytes a second each way."""
_ASKED_MOST = 50


class Timesync:
    """exchanged: called with (sent UTC, time since boot, heard UTC) in seconds for every answer to one of ours."""

    def __init__(self, link: MavlinkLink, clock: Clock, exchanged: Callable[[float, float, float], None]) -> None:
        self._link = link
        self._clock = clock
        self._exchanged = exchanged
        self._asked: dict[int, float] = {}

    async def run(self) -> None:
        """Until cancelled."""
        while True:
            await self.ask()
            await asyncio.sleep(EVERY_WALL_S)

    async def ask(self) -> None:
        """Send one; its answer comes through `heard`."""
        token = time.monotonic_ns()

        def stamp() -> bool:
            self._asked[token] = self._clock.now()
            return True

        await self._link.send("TIMESYNC", {"tc1": 0, "ts1": token}, stamp)
        while len(self._asked) > _ASKED_MOST:
            self._asked.pop(next(iter(self._asked)))

    def heard(self, fields: Fields, heard_at_s: float) -> None:
        """A TIMESYNC came: the answer to one of ours, or somebody else's business."""
        boot_ns, sent_at_s = int(fields["tc1"]), self._asked.pop(int(fields["ts1"]), None)
        if boot_ns > 0 and sent_at_s is not None:
            self._exchanged(sent_at_s, boot_ns / 1e9, heard_at_s)
