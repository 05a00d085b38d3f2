"""Commands with acknowledgement: sent only while allowed, sent again visibly, refused in words."""

from __future__ import annotations

import asyncio
import logging
from collections import defaultdict
from collections.abc import Callable

from hardware.autopilot.control import ControlLatch
from hardware.autopilot.link import Fields, MavlinkLink
from hardware.autopilot.messages import ACCEPTED, IN_PROGRESS, RESULTS, Outgoing
from hardware.autopilot.patience import Deadline
from hardware.ports import Clock, PilotHasControl, VehicleError

log = logging.getLogger(__name__)

ACK_S, ACK_WALL_S, ATTEMPTS = 1.5, 1.0, 3


class CommandRefused(VehicleError):
    """The autopilot answered, and said no."""


class ManoeuvreSuperseded(VehicleError):
    """A later order (hold, return, another flight) replaced this one."""


class Manoeuvre:
    """One thing the vehicle was told to do; a later one supersedes it, and then it sends nothing more."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.superseded_by: str | None = None


class Commander:
    """Sends commands for manoeuvres. The pilot latch and the manoeuvre are asked in the instant before each send."""

    def __init__(self, link: MavlinkLink, clock: Clock, latch: ControlLatch, announce: Callable[[str], None]) -> None:
        self._link = link
        self._clock = clock
        self._latch = latch
        self._announce = announce
        self._waiting: dict[int, list[asyncio.Future[int]]] = defaultdict(list)

    def acknowledged(self, fields: Fields) -> None:
        """A COMMAND_ACK came."""
        for future in self._waiting.get(int(fields["command"]), ()):
            if not future.done():
                future.set_result(int(fields["result"]))

    def check(self, manoeuvre: Manoeuvre) -> None:
        """Raises PilotHasControl or ManoeuvreSuperseded when this manoeuvre may not go on."""
        if self._latch.reason is not None:
            raise PilotHasControl(f"{manoeuvre.name} is not possible: {self._latch.reason}. Resume to fly on.")
        if manoeuvre.superseded_by is not None:
            raise ManoeuvreSuperseded(f"{manoeuvre.name} was replaced by {manoeuvre.superseded_by}.")

    async def order(self, manoeuvre: Manoeuvre, outgoing: Outgoing, modes: frozenset[int], what: str) -> None:
        """Send a flight command until it is acknowledged. `modes`: the raw modes that are ours after it.

        Raises CommandRefused, PilotHasControl, ManoeuvreSuperseded, VehicleError (no answer).
        """

        def allowed() -> bool:
            return self._latch.reason is None and manoeuvre.superseded_by is None

        for attempt in range(1, ATTEMPTS + 1):
            self.check(manoeuvre)
            self._latch.command(modes)
            result = await self._exchange(outgoing, attempt, allowed)
            self.check(manoeuvre)
            if result == ACCEPTED:
                self._latch.acknowledged()
                return
            if result is not None:
                raise CommandRefused(f"The autopilot refused {what}: {_in_words(result)}.")
            if attempt < ATTEMPTS:
                self._announce(f"no answer to {what}, sent again ({attempt + 1} of {ATTEMPTS})")
        raise VehicleError(f"The autopilot did not answer {what} ({ATTEMPTS} times sent). Check the link.")

    async def ask(self, outgoing: Outgoing) -> bool:
        """Send a command that moves nothing (telemetry rates); True when accepted. The pilot may have control."""
        for attempt in range(1, ATTEMPTS + 1):
            result = await self._exchange(outgoing, attempt, lambda: True)
            if result is not None:
                return result == ACCEPTED
        return False

    async def _exchange(self, outgoing: Outgoing, attempt: int, allowed: Callable[[], bool]) -> int | None:
        """The final MAV_RESULT, or None when none came (or nothing was sent)."""
        fields = outgoing.fields
        if outgoing.message == "COMMAND_LONG":
            fields = fields | {"confirmation": attempt - 1}
        waiting = self._waiting[outgoing.number]
        future: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        waiting.append(future)
        try:
            if not await self._link.send(outgoing.message, fields, allowed):
                return None
            result = await self._answer(future, Deadline(self._clock, ACK_S, ACK_WALL_S), allowed)
            if result == IN_PROGRESS:
                waiting.remove(future)
                future = asyncio.get_running_loop().create_future()
                waiting.append(future)
                result = await self._answer(future, Deadline(self._clock, 10.0, 5.0), allowed)
            return result
        finally:
            waiting.remove(future)

    async def _answer(self, future: asyncio.Future[int], deadline: Deadline, allowed: Callable[[], bool]) -> int | None:
        while not deadline.passed and allowed():
            done, _ = await asyncio.wait((future,), timeout=0.05)
            if done:
                return future.result()
        return None


def _in_words(result: int) -> str:
    return RESULTS[result] if 0 <= result < len(RESULTS) else f"result {result}"
