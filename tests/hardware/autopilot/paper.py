"""A monitor that hears what a test says, without a network."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, cast

from hardware.autopilot.commander import Commander
from hardware.autopilot.link import Fields, MavlinkLink
from hardware.autopilot.messages import REQUEST_MESSAGE
from hardware.autopilot.monitor import Monitor
from hardware.autopilot.px4 import px4_mode
from hardware.clock import WallClock

POSCTL = px4_mode(3)
ON_GROUND, IN_AIR = 1, 2
PLACE: Fields = {"time_boot_ms": 1000, "lat": 473977419, "lon": 85455938, "alt": 528_000, "relative_alt": 40_000}
PLACE |= {"vx": 0, "vy": 0, "vz": 0}


class HandClock(WallClock):
    """Time moves when told."""

    def __init__(self) -> None:
        self.at = 1_000.0

    def now(self) -> float:
        return self.at


class PaperLink:
    """A command is acknowledged at once, unless `answers` is False. `opened`: what is heard while the link is opened;
    `requested`: what is heard when a message of that number is asked for; `sent`: MAV_CMD, `fields`: of each."""

    url = "paper"

    def __init__(self, heard: Callable[[str, Fields], None], opened: list[tuple[str, Fields]]) -> None:
        self.heard = heard
        self.opened = opened
        self.sent: list[int] = []
        self.fields: list[Fields] = []
        self.answers = True
        self.requested = dict[int, tuple[str, Fields]]()
        self.result = 0
        """MAV_RESULT of the acknowledgements."""

    async def open(self, timeout_s: float) -> None:
        for name, fields in self.opened:
            self.heard(name, fields)

    async def send(self, name: str, fields: Fields, allowed: Callable[[], bool]) -> bool:
        if not allowed():
            return False
        if name in ("TIMESYNC", "PING"):
            return True
        number = fields["command"]
        self.sent.append(number)
        self.fields.append(fields)
        if number == REQUEST_MESSAGE and fields["param1"] in self.requested:
            self.heard(*self.requested[fields["param1"]])
        if not self.answers:
            return True
        asyncio.get_running_loop().call_soon(self.heard, "COMMAND_ACK", {"command": number, "result": self.result})
        return True

    async def parameter(self, name: str) -> float | None:
        return None

    async def close(self) -> None:
        pass


class Scene:
    def __init__(self, *opened: tuple[str, Fields]) -> None:
        self.clock = HandClock()
        self.monitor = Monitor("udpin://127.0.0.1:1", self.clock)
        self.link = PaperLink(self.hear, list(opened))
        self.monitor.link = link = cast(MavlinkLink, self.link)
        self.monitor.commander = Commander(
            link, self.clock, self.monitor.control, self.monitor.announce, self.monitor.mode_heard, lambda: 0.0
        )

    def hear(self, name: str, fields: Fields) -> None:
        self.clock.at += 0.01
        self.monitor._on_message(name, fields)

    def mode(self, mode: int) -> None:
        self.hear("CURRENT_MODE", {"custom_mode": mode})

    def heartbeat(self, mode: int, armed: bool) -> None:
        self.hear(*heartbeat(mode, armed))

    def landed(self, state: int) -> None:
        self.hear("EXTENDED_SYS_STATE", {"landed_state": state})

    def silence(self, seconds: float) -> None:
        self.clock.at += seconds
        for _ in range(int(seconds / 0.5)):
            self.monitor.look_at_link(0.5)


def heartbeat(mode: int, armed: bool) -> tuple[str, dict[str, Any]]:
    return "HEARTBEAT", {"custom_mode": mode, "base_mode": 1 | 128 * armed, "autopilot": 12}
