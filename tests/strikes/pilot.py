"""The pilot of a real autopilot: mode switch and sticks, as a transmitter or a second ground station bring them to it.

The pilot's radio has no delay, so it is put in at the vehicle's end of the proxy.
"""

from __future__ import annotations

import asyncio
import contextlib
import sys
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any

from pymavlink.dialects.v20 import development as mavlink

from hardware.autopilot.messages import SET_MODE
from tests.strikes.hands import NEUTRAL, PILOT_COMPONENT, PILOT_SYSTEM, PUSHED
from tests.strikes.proxy import (
    COMMAND_ACK,
    COMMAND_INT,
    COMMAND_LONG,
    CURRENT_MODE,
    HEARTBEAT,
    RC_CHANNELS,
    STATUS_TEXT,
    Passed,
    Proxy,
)
from tests.strikes.transmitter import Switch, Transmitter


@dataclass(frozen=True, slots=True)
class Habits:
    """An autopilot's modes in which the pilot flies, and in which they give the vehicle back.

    flown, given_back: (custom mode as commanded, raw mode as reported). sticks_take: moving them ends an
    automatic mode. switch: of the transmitter, where it can be moved.
    """

    flown: tuple[tuple[float, float], int]
    given_back: tuple[tuple[float, float], int]
    sticks_take: bool
    sticks_text: str = ""
    switch: Switch | None = None


HABITS = {
    "px4": Habits(((3.0, 0.0), 3 << 16), ((4.0, 3.0), 4 << 16 | 3 << 24), True, "Pilot took over"),
    "ardupilot": Habits(((5.0, 0.0), 5), ((17.0, 0.0), 17), False, switch=Switch(5, 1685, 1555, 0.2)),
}
"""POSCTL and HOLD; LOITER and BRAKE, on the switch with FLTMODE5 5 and FLTMODE4 17."""
WITHIN_US = 50
"""A pulse is heard as it was sent, but for the noise of a receiver."""


class Pilot:
    """flies: raw mode in which the pilot has the vehicle. transmitter: None: they switch by a second ground station."""

    def __init__(self, proxy: Proxy, habits: Habits, transmitter: Transmitter | None = None) -> None:
        self.habits = habits
        self.transmitter = transmitter
        self.flies = habits.flown[1]
        self._proxy = proxy
        self._encoder = mavlink.MAVLink(None, PILOT_SYSTEM, PILOT_COMPONENT)
        self._sticks = NEUTRAL
        self._hands: asyncio.subprocess.Process | None = None

    def _send(self, message: Any) -> float:
        return self._proxy.put_in(bytes(message.pack(self._encoder)), message.get_msgId(), message.to_dict())

    @property
    def believed_s(self) -> float:
        """From the pilot's hand at the mode switch until the autopilot changes its mode."""
        return 0.0 if self.transmitter is None else self.transmitter.switch.believed_s

    def _switch(self, custom: tuple[float, float]) -> float:
        return self._send(
            self._encoder.command_long_encode(
                self._proxy.system, 1, SET_MODE, 0, 1.0, custom[0], custom[1], 0.0, 0.0, 0.0, 0.0
            )
        )

    def command(self, number: int, *params: float) -> float:
        """Any other command of the second station: failures made on purpose, for instance."""
        given = (*params, *(0.0,) * (7 - len(params)))
        return self._send(self._encoder.command_long_encode(self._proxy.system, 1, number, 0, *given))

    def take_by_mode(self) -> float:
        """When, by time.monotonic."""
        if self.transmitter is None:
            return self._switch(self.habits.flown[0])
        self.transmitter.take()
        return time.monotonic()

    def take_by_sticks(self) -> float:
        """Push them; `release_sticks` ends it."""
        self._sticks = PUSHED
        self._tell_hands()
        return self._move()

    def release_sticks(self) -> None:
        if self._sticks != NEUTRAL:
            self._sticks = NEUTRAL
            self._tell_hands()

    def give_back(self) -> float:
        self.release_sticks()
        if self.transmitter is None:
            return self._switch(self.habits.given_back[0])
        self.transmitter.give_back()
        return time.monotonic()

    def on_the_ground(self) -> None:
        """Hands ready for a take-off."""
        if self.transmitter is not None:
            self.transmitter.throttle_down()

    def _move(self) -> float:
        return self._send(self._encoder.manual_control_encode(self._proxy.system, *self._sticks, 0))

    async def hands_on(self) -> None:
        """The transmitter stays switched on: without it the autopilot refuses the modes that a pilot flies."""
        while (address := self._proxy.vehicle_address()) is None:
            self._move()
            await asyncio.sleep(0.05)
        self._move()  # by the proxy: PX4 answers whoever spoke first, and for good
        host, port = address
        given = (sys.executable, "-m", "tests.strikes.hands", host, str(port), str(self._proxy.system))
        self._hands = await asyncio.create_subprocess_exec(*given, stdin=asyncio.subprocess.PIPE)
        try:
            self._tell_hands()
            await self._hands.wait()
            raise ChildProcessError("The pilot's hands left the sticks.")
        finally:
            if self._hands.returncode is None:
                self._hands.kill()
                await self._hands.wait()

    def _tell_hands(self) -> None:
        if self._hands is not None and self._hands.stdin is not None:
            self._hands.stdin.write(f"{' '.join(map(str, self._sticks))}\n".encode())

    def took(self, since_s: float) -> float | None:
        """When the autopilot first said that the pilot has it (its answer, its text or its mode).

        A switch that it heard and obeyed without ever telling the mode: when it did, at the latest.
        """
        passed = self._proxy.since(since_s)
        said = next((one.at_s for one in passed if self._says_taken(one)), None)
        if said is not None or self.transmitter is None:
            return said
        moved = next((one.at_s for one in passed if self._says_moved(one, self.transmitter.switch)), None)
        return None if moved is None else moved + self.believed_s

    def _says_moved(self, passed: Passed, switch: Switch) -> bool:
        if passed.way != "from" or passed.number != RC_CHANNELS:
            return False
        return abs(int(passed.fields.get(f"chan{switch.channel}_raw", 0)) - switch.flown_us) < WITHIN_US

    def _says_taken(self, passed: Passed) -> bool:
        fields = passed.fields
        if passed.way != "from":
            return False
        if passed.number == COMMAND_ACK:
            mine = fields.get("target_system") == PILOT_SYSTEM and fields["command"] == SET_MODE
            return bool(mine and fields["result"] == mavlink.MAV_RESULT_ACCEPTED)
        if passed.number == STATUS_TEXT:
            return bool(self.habits.sticks_text) and str(fields["text"]).startswith(self.habits.sticks_text)
        return mode_of(passed) == self.flies


def mode_of(passed: Passed) -> int | None:
    """The raw mode, of a message of the vehicle that tells it."""
    if passed.way != "from" or passed.number not in (HEARTBEAT, CURRENT_MODE):
        return None
    if passed.number == HEARTBEAT and passed.fields.get("autopilot") == mavlink.MAV_AUTOPILOT_INVALID:
        return None
    mode = passed.fields.get("custom_mode")
    return None if mode is None else int(mode)


@asynccontextmanager
async def piloted(proxy: Proxy, flavour: str, rc: tuple[str, int] | None = None) -> AsyncIterator[Pilot]:
    """A pilot with the transmitter in their hands, where that is read as MANUAL_CONTROL or sent to `rc`."""
    habits = HABITS[flavour]
    pilot = Pilot(proxy, habits, None if rc is None or habits.switch is None else Transmitter(rc, habits.switch))
    hands = asyncio.create_task(pilot.hands_on()) if pilot.habits.sticks_take else None
    try:
        yield pilot
    finally:
        if hands is not None:
            hands.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await hands
        if pilot.transmitter is not None:
            pilot.transmitter.close()


def reaching(proxy: Proxy, since_s: float, numbers: frozenset[int]) -> list[float]:
    """Seconds after `since_s` at which commands of the program under test reached the vehicle."""
    return [
        passed.at_s - since_s
        for passed in proxy.since(since_s)
        if passed.way == "to"
        and passed.number in (COMMAND_LONG, COMMAND_INT)
        and int(passed.fields["command"]) in numbers
    ]
