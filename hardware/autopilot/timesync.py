"""MAVLink TIMESYNC: ask the autopilot for its time since boot, again and again, and time the answers.

PX4 1.16 leaves the target of its answers uninitialised, and MAVSDK withholds what is addressed to somebody else. While
no answer comes a PING goes with each question: its answer tells how long both ways take.
"""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable
from typing import Protocol

from hardware.autopilot.link import Fields, MavlinkLink
from hardware.autopilot.silence import Silence
from hardware.ports import Clock

EVERY_WALL_S = 0.2
"""280 bytes a second each way."""
UNANSWERED = 5
"""After this number of questions in a row without an answer, a PING goes with each."""
_ASKED_MOST = 50
_ROUNDS_KEPT = 100
_EVERYBODY = {"target_system": 0, "target_component": 0}
"""Of a PING: a question; with a target it is an answer."""


class Timed(Protocol):
    """Whoever learns from the answers, in seconds."""

    def exchanged(self, sent_at_s: float, boot_s: float, heard_at_s: float) -> None:
        """Asked at, the autopilot's time since boot, heard at (UTC)."""
        ...

    def went_round(self, sent_at_s: float, heard_at_s: float) -> None:
        """Asked at, heard at (UTC)."""
        ...


class Timesync:
    """Asks through the link; what the answers say goes to `timed`.

    unanswered: since when no answer has come; None before the first: some autopilot may never answer.
    """

    def __init__(self, link: MavlinkLink, clock: Clock, timed: Timed) -> None:
        self._link = link
        self._clock = clock
        self._timed = timed
        self._asked: dict[int, float] = {}
        self._pinged: dict[int, float] = {}
        self._unanswered = 0
        self.unanswered: Silence | None = None
        self._rounds_s: deque[float] = deque(maxlen=_ROUNDS_KEPT)

    @property
    def quickest_s(self) -> float:
        """From a question to its answer, at least, of late and by the wall clock; 0 before any was answered."""
        return min(self._rounds_s, default=0.0)

    async def run(self) -> None:
        """Until cancelled."""
        while True:
            await self.ask()
            await asyncio.sleep(EVERY_WALL_S)

    async def ask(self) -> None:
        """Send one; its answer comes through `heard`."""
        token = time.monotonic_ns()
        await self._link.send("TIMESYNC", {"tc1": 0, "ts1": token}, self._stamp(self._asked, token))
        self._unanswered += 1
        if self._unanswered > UNANSWERED:
            await self._ping()

    async def _ping(self) -> None:
        token = time.monotonic_ns() // 1000
        ping = {"time_usec": token, "seq": token & 0xFFFF, **_EVERYBODY}
        await self._link.send("PING", ping, self._stamp(self._pinged, token))

    def _stamp(self, sent: dict[int, float], token: int) -> Callable[[], bool]:
        """Keeps when it was sent, in the instant before."""

        def stamp() -> bool:
            sent[token] = self._clock.now()
            while len(sent) > _ASKED_MOST:
                sent.pop(next(iter(sent)))
            return True

        return stamp

    def heard(self, fields: Fields, heard_at_s: float) -> None:
        """A TIMESYNC came: the answer to one of ours, or somebody else's business."""
        boot_ns, sent_at_s = int(fields["tc1"]), self._asked.pop(int(fields["ts1"]), None)
        if boot_ns > 0 and sent_at_s is not None:
            self._unanswered = 0
            self._came_round((time.monotonic_ns() - int(fields["ts1"])) / 1e9)
            self._timed.exchanged(sent_at_s, boot_ns / 1e9, heard_at_s)

    def came_back(self, fields: Fields, heard_at_s: float) -> None:
        """A PING came: ours with its answer, or somebody else's business."""
        sent_at_s = self._pinged.pop(int(fields["time_usec"]), None)
        if sent_at_s is not None and int(fields["target_system"]) != 0:
            self._came_round((time.monotonic_ns() // 1000 - int(fields["time_usec"])) / 1e6)
            self._timed.went_round(sent_at_s, heard_at_s)

    def _came_round(self, seconds: float) -> None:
        self._rounds_s.append(seconds)
        self.unanswered = self.unanswered or Silence()
        self.unanswered.heard()
