"""One aimed takeover and what became of it, judged at the vehicle's end of the link."""

from __future__ import annotations

import asyncio
import random
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from hardware.autopilot.vehicle import MavsdkVehicle
from planner.reason import text_of
from tests.strikes.pilot import Pilot, mode_of, reaching
from tests.strikes.proxy import COMMAND_ACK, COMMAND_INT, COMMAND_LONG, HEARTBEAT, STATUS_TEXT, Passed, Proxy

Means = Literal["mode", "sticks"]
Moment = Literal["crossing", "before", "under way"]
"""crossing: the command has left us and not reached the vehicle. before: the order is given just after the takeover,
before its news can be here. under way: at any moment."""

FLIGHT = frozenset({16, 20, 21, 22, 115, 176, 178, 192, 400})
"""MAV_CMD that move the vehicle: waypoint, return, land, take-off, yaw, mode, speed, reposition, arm."""
WATCHED_S = 3.0
NOTICED_S = 1.0
REPORT_S = 0.12
"""The autopilot reports its mode at most this long after a change (ten times a second)."""
STICKS_S = 0.5
READY_S = 120.0
CRITICAL = 5
"""MAV_STATE of a HEARTBEAT."""
STORY_FROM_S = 2.0
"""How long before its strike a story begins."""
STALE_S = 0.15
"""A report of the mode that was under way inside the autopilot when the pilot took it may still be of before."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """undone: the autopilot left the pilot's mode without them. noticed_s: until we knew; None: not within a second.

    took_s: until the autopilot said so; None: never, the switch did not take. back_to: the raw mode that undid it.
    told_s: until a report of that mode left the autopilot; None: none did. stalled_s: the longest that this process,
    with the program under test in it, did nothing at all meanwhile. held_up_s: by how much it delivered what the link
    carries later than due, at most. known: what the program knew in the end. failsafe: the autopilot said meanwhile
    that a failsafe of its own acts. story: what passed at the vehicle's end of the link, when it was undone or not
    noticed in time.
    last_command_s: the last flight command that reached the vehicle, after the strike; 0 when none did.
    """

    scene: str
    moment: Moment
    means: Means
    delay_s: float
    took_s: float | None
    undone: bool
    back_to: int | None
    noticed_s: float | None
    last_command_s: float
    commands: int
    told_s: float | None = None
    stalled_s: float = 0.0
    held_up_s: float = 0.0
    known: str = ""
    failsafe: bool = False
    story: tuple[str, ...] = ()

    @property
    def counts(self) -> bool:
        return self.took_s is not None

    @property
    def unaware_s(self) -> float | None:
        """From the autopilot's first word that the pilot has it until we knew; None: we never did. A busy simulator
        takes up to 1.7 s to obey its pilot; nobody else can know earlier."""
        return None if self.noticed_s is None else max(0.0, self.noticed_s - (self.took_s or 0.0))


class Aim:
    """Fires once: at a flight command in the air, or after a time; `at_s` tells when it did."""

    def __init__(self, proxy: Proxy, pilot: Pilot, means: Means, chance: random.Random) -> None:
        self._proxy = proxy
        self._pilot = pilot
        self._means: Means = means
        self._chance = chance
        self.fired = asyncio.Event()
        self.at_s = 0.0

    def at_command(self, numbers: frozenset[int], skip: int) -> None:
        """While the `skip`-th next command of these numbers is under way to the vehicle."""
        left = skip

        def sent(number: int, fields: dict[str, object]) -> None:
            nonlocal left
            if number not in (COMMAND_INT, COMMAND_LONG) or int(str(fields["command"])) not in numbers:
                return
            left -= 1
            if left < 0:
                self._proxy.on_sent = None
                self.after(self._chance.uniform(0.0, self._proxy.delay_s))

        self._proxy.on_sent = sent

    def after(self, seconds: float) -> None:
        if seconds <= 0.0:
            self._fire()
        else:
            asyncio.get_running_loop().call_later(seconds, self._fire)

    def _fire(self) -> None:
        if not self.fired.is_set():
            self.at_s = self._pilot.take_by_sticks() if self._means == "sticks" else self._pilot.take_by_mode()
            self.fired.set()


async def watch(
    aim: Aim, proxy: Proxy, pilot: Pilot, vehicle: MavsdkVehicle, scene: str, moment: Moment, means: Means
) -> Outcome:
    """From the strike on for three seconds and both ways of the link."""
    end_s = aim.at_s + WATCHED_S + 2.0 * proxy.delay_s
    noticed_s, stalled_s, looked_s = None, 0.0, time.monotonic()
    proxy.held_up_s()
    while (now_s := time.monotonic()) < end_s:
        stalled_s, looked_s = max(stalled_s, now_s - looked_s), now_s
        if now_s > aim.at_s + STICKS_S:
            pilot.release_sticks()
        if noticed_s is None and vehicle.telemetry().authority.taken_by is not None:
            noticed_s = now_s - aim.at_s
        await asyncio.sleep(0.01)
    took_at_s = pilot.took(aim.at_s)
    back_to = None if took_at_s is None else left_for(proxy, pilot, took_at_s)
    late = reaching(proxy, aim.at_s, FLIGHT)
    odd = back_to is not None or noticed_s is None
    return Outcome(
        scene=scene,
        moment=moment,
        means=means,
        delay_s=proxy.delay_s,
        took_s=None if took_at_s is None else took_at_s - aim.at_s,
        undone=back_to is not None,
        back_to=back_to,
        noticed_s=noticed_s,
        last_command_s=max(late, default=0.0),
        commands=len(late),
        told_s=_told(proxy, pilot, aim.at_s),
        stalled_s=stalled_s,
        held_up_s=proxy.held_up_s(),
        known=_known(vehicle),
        failsafe=any(
            passed.way == "from" and passed.number == HEARTBEAT and passed.fields.get("system_status") == CRITICAL
            for passed in proxy.since(aim.at_s)
        ),
        story=tuple(story(proxy.since(aim.at_s - STORY_FROM_S), aim.at_s)) if odd else (),
    )


def story(record: Sequence[Passed], at_s: float) -> Iterator[str]:
    """Commands, answers, texts and each change of the mode, with seconds since `at_s`."""
    before = None
    for passed in record:
        of, shown = passed.fields, ""
        if passed.number in (COMMAND_INT, COMMAND_LONG):
            shown = f"command {of['command']:.0f} ({of['param1']:g}, {of['param2']:g}, {of['param3']:g})"
        elif passed.number == COMMAND_ACK:
            shown = f"answer {of['result']} to {of['command']}, for {of.get('target_system')}"
        elif passed.number == STATUS_TEXT:
            shown = str(of["text"]).strip()
        elif (mode := mode_of(passed)) is not None:
            now = mode, of.get("intended_custom_mode"), of.get("system_status")
            now = tuple(new if new is not None else old for new, old in zip(now, before or (None,) * 3, strict=True))
            if now != before:
                shown = f"mode {now[0]:#x}, intended {now[1]}, system status {now[2]}"
            before = now
        if shown:
            yield f"{passed.at_s - at_s:+.3f} s {passed.way}: {shown}"


def _told(proxy: Proxy, pilot: Pilot, since_s: float) -> float | None:
    told = (passed.at_s for passed in proxy.since(since_s) if mode_of(passed) == pilot.flies)
    return next((at_s - since_s for at_s in told), None)


def _known(vehicle: MavsdkVehicle) -> str:
    heard = vehicle.telemetry()
    age_s = None if heard.mode_at_s is None else round(heard.at_s - heard.mode_at_s, 2)
    return f"mode {heard.mode} {age_s} s ago, armed {heard.armed}, in the air {heard.in_air}, {heard.authority}"


def left_for(proxy: Proxy, pilot: Pilot, took_at_s: float) -> int | None:
    """The first mode reported after the takeover that is not the pilot's; sticks that take again do not mend it."""
    told = [mode_of(passed) for passed in proxy.since(took_at_s + STALE_S)]
    return next((mode for mode in told if mode is not None and mode != pilot.flies), None)


async def ready(vehicle: MavsdkVehicle) -> None:
    """Waits as an operator would for an autopilot that was just started; raises TimeoutError with what stays wrong."""
    wrong, end_s = "", time.monotonic() + READY_S
    while time.monotonic() < end_s:
        checks = await vehicle.preflight()
        found = [text_of(check.reason) for check in checks if check.blocking and not check.ok]
        if not found:
            return
        wrong = " / ".join(found)
        await asyncio.sleep(1.0)
    raise TimeoutError(f"the vehicle is not ready: {wrong}")


async def until(happened: Callable[[], bool], seconds: float, what: str) -> None:
    """Raises TimeoutError that says what did not happen."""
    end_s = time.monotonic() + seconds
    while not happened():
        if time.monotonic() > end_s:
            raise TimeoutError(f"{what}: not within {seconds:g} s")
        await asyncio.sleep(0.05)
