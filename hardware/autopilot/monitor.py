"""What is heard of one vehicle: snapshot, link, who has control. It asks for telemetry and commands nothing."""

from __future__ import annotations

import asyncio
import logging
import math
import time
from collections.abc import AsyncIterator

from hardware.autopilot.ardupilot import ARDUPILOT
from hardware.autopilot.commander import Commander
from hardware.autopilot.control import ControlLatch
from hardware.autopilot.dialect import Dialect
from hardware.autopilot.link import Fields, MavlinkLink
from hardware.autopilot.messages import HOME_POSITION_ID, message_interval, request_message
from hardware.autopilot.patience import Announcer, Deadline, News, Silence
from hardware.autopilot.px4 import PX4
from hardware.autopilot.snapshot import NAMES, Snapshot
from hardware.ports import Clock, VehicleUnreachable
from hardware.readings import Telemetry

log = logging.getLogger(__name__)

DIALECTS: dict[int, Dialect] = {12: PX4, 3: ARDUPILOT}
"""MAV_AUTOPILOT -> dialect."""
STREAMS: tuple[tuple[int, float], ...] = (
    (436, 10.0),  # CURRENT_MODE: takeover in about 0.1 s where the heartbeat takes up to 1 s
    (30, 20.0),  # ATTITUDE
    (33, 10.0),  # GLOBAL_POSITION_INT
    (245, 5.0),  # EXTENDED_SYS_STATE
    (24, 1.0),  # GPS_RAW_INT
    (1, 1.0),  # SYS_STATUS
    (147, 1.0),  # BATTERY_STATUS
    (HOME_POSITION_ID, 0.5),
)
LINK_LOST_WALL_S = 3.0
STREAMS_CEASED_S = 3.0
GIVEN_BACK_S = 1.5
"""A mode counts as the pilot's answer only when it was heard so much later than he took over: PX4 says that the sticks
took over before it says the mode."""


class Monitor:
    """Everything one instance of MavsdkVehicle knows. Its parts are public to the manoeuvres of this package."""

    def __init__(self, url: str, clock: Clock) -> None:
        self.clock = clock
        self.link = MavlinkLink(url, (*NAMES, "COMMAND_ACK", "STATUSTEXT"), self._on_message)
        self.snapshot = Snapshot()
        self.news = News()
        self.connected = False
        self._dialect: Dialect | None = None
        self._autopilot_number: int | None = None
        self._announcer = Announcer()
        self._listen(frozenset())
        self.silence = Silence()
        self._lost_at_s: float | None = None
        self._shown_mode: int | None = None
        self._taken_at_s = -math.inf
        self._tasks: list[asyncio.Task[None]] = []

    def _listen(self, calm: frozenset[int]) -> None:
        self.latch = ControlLatch(calm, self.mode_name)
        self.commander = Commander(self.link, self.clock, self.latch, self.announce)

    async def connect(self, timeout_s: float = 30.0) -> None:
        """Open the link and wait for an autopilot (wall seconds). Raises VehicleUnreachable."""
        try:
            await self._connect(timeout_s)
        except BaseException:
            await self.close()
            raise

    async def _connect(self, timeout_s: float) -> None:
        started = time.monotonic()
        await self.link.open(timeout_s)
        while self._autopilot_number is None:
            if time.monotonic() - started > timeout_s:
                raise VehicleUnreachable(f"An autopilot was there on {self.link.url}, but its heartbeat stopped.")
            await self.news.wait()
        dialect = DIALECTS.get(self._autopilot_number)
        if dialect is None:
            raise VehicleUnreachable(
                f"The autopilot on {self.link.url} is neither PX4 nor ArduPilot "
                f"(MAV_AUTOPILOT {self._autopilot_number})."
            )
        self._dialect = dialect
        self._listen(dialect.calm)
        self.connected = True
        self.announce(f"connected to {dialect.name} on {self.link.url}")
        await self._request_streams()
        first = Deadline(self.clock, 5.0, 3.0)
        while (self.snapshot.position is None or self.snapshot.in_air is None) and not first.passed:
            await self.news.wait()
        self._on_mode()  # before anything is commanded it is known whether a pilot flies
        self._tasks = [
            asyncio.create_task(self._watch_link(), name="vehicle-link-watch"),
            asyncio.create_task(self._keep_streams(), name="vehicle-streams"),
        ]

    async def close(self) -> None:
        """Idempotent. The vehicle goes on with what it was told."""
        tasks, self._tasks = self._tasks, []
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        self.connected = False
        await self.link.close()
        self._announcer.end()

    async def _request_streams(self) -> None:
        for message_id, hz in STREAMS:
            if not await self.commander.ask(message_interval(message_id, hz)):
                log.info("the autopilot does not stream MAVLink message %d", message_id)
        await self.commander.ask(request_message(HOME_POSITION_ID))

    async def _keep_streams(self) -> None:
        """Ask for the telemetry rates again when the autopilot has forgotten them."""
        reboots = self.snapshot.reboots
        while True:
            await asyncio.sleep(1.0)
            attitude = self.snapshot.attitude_heard_at_s
            ceased = attitude is None or self.clock.now() - attitude > STREAMS_CEASED_S
            if self.snapshot.reboots != reboots:
                reboots = self.snapshot.reboots
                self.announce("the autopilot has started anew")
            elif not ceased or self.silence.seconds > LINK_LOST_WALL_S:
                continue
            await self._request_streams()

    async def _watch_link(self) -> None:
        looked = time.monotonic()
        while True:
            await asyncio.sleep(0.1)
            before, looked = looked, time.monotonic()
            self.look_at_link(looked - before)

    def look_at_link(self, elapsed_s: float) -> None:
        """Is the vehicle still heard? So many seconds of the wall after the look before."""
        self.silence.look(elapsed_s)
        lost = self.silence.seconds > LINK_LOST_WALL_S
        if lost and self.connected:
            self.connected, self._lost_at_s = False, self.snapshot.heard_at_s
            self.snapshot.forget_landed()
            self.announce("vehicle link lost")
            self.news.tell()
        elif not lost and not self.connected and self._heartbeat_heard_again:
            self.connected = True
            outage = self.clock.now() - (self._lost_at_s or self.clock.now())
            self.announce(f"vehicle link restored after {outage:.1f} s")
            self.news.tell()

    @property
    def _heartbeat_heard_again(self) -> bool:
        """Before anything is commanded after a silence, what the vehicle did meanwhile is known: mode and arming."""
        return (self.snapshot.heartbeat_at_s or -math.inf) > (self._lost_at_s or -math.inf)

    def _on_message(self, name: str, fields: Fields) -> None:
        now = self.clock.now()
        self.silence.heard()
        if name == "COMMAND_ACK":
            self.commander.acknowledged(fields)
        elif name == "STATUSTEXT":
            self._on_text(str(fields["text"]).rstrip("\x00\t "))
        else:
            if name == "HEARTBEAT":
                self._autopilot_number = int(fields["autopilot"])
            self.snapshot.fold(name, fields, now)
            if name == "GLOBAL_POSITION_INT" and self.snapshot.jumped_m is not None:
                self.announce(f"GPS position jumped by {self.snapshot.jumped_m:.0f} m")
            if name in ("HEARTBEAT", "CURRENT_MODE", "EXTENDED_SYS_STATE"):
                self._on_mode()
        self.news.tell()

    def _on_text(self, text: str) -> None:
        log.info("autopilot: %s", text)
        if text.startswith("Pilot took over") and self.latch.reason is None and self.snapshot.armed:
            self._take_over(self.latch.latch("the pilot took over using the sticks"))

    def _on_mode(self) -> None:
        snapshot = self.snapshot
        mode = snapshot.custom_mode
        if mode is None or snapshot.armed is None or self._dialect is None:
            return
        if mode != self._shown_mode:
            if self._shown_mode is not None:
                self.announce(f"mode {self.mode_name(mode)}")
            self._shown_mode = mode
        if not self.connected and mode in self._dialect.calm and not self._heartbeat_heard_again:
            return  # an autopilot goes there by itself when it has landed, as it may have done unheard
        reason = self.latch.observe(mode, snapshot.armed, bool(snapshot.in_air))
        if reason is not None:
            self._take_over(reason)

    def _take_over(self, reason: str) -> None:
        self._taken_at_s = self.clock.now()
        self.announce(f"pilot took over: {reason}")
        self.news.tell()

    def announce(self, line: str) -> None:
        log.info("vehicle: %s", line)
        self._announcer.say(line)

    def mode_name(self, custom_mode: int) -> str:
        return f"mode {custom_mode}" if self._dialect is None else self._dialect.mode_name(custom_mode)

    @property
    def dialect(self) -> Dialect:
        """Raises VehicleUnreachable before an autopilot was heard."""
        self.check_connected()
        assert self._dialect is not None
        return self._dialect

    def check_connected(self) -> None:
        """Raises VehicleUnreachable before an autopilot was heard (a link that was lost since is no matter)."""
        if self._dialect is None:
            raise VehicleUnreachable(f"No vehicle is connected on {self.link.url}.")

    @property
    def held_by_pilot(self) -> bool:
        """Somebody else took control, and the vehicle's mode does not say that it was given back."""
        snapshot, latch = self.snapshot, self.latch
        if latch.reason is None or not snapshot.armed:
            return False
        return latch.held or (snapshot.mode_at_s or -math.inf) < self._taken_at_s + GIVEN_BACK_S

    def telemetry(self) -> Telemetry:
        mode = self.snapshot.custom_mode
        return self.snapshot.telemetry(
            self.clock.now(),
            self.connected,
            None if mode is None else self.mode_name(mode),
            self.latch.controller,
            self.held_by_pilot,
            "unknown" if self._dialect is None else self._dialect.name,
        )

    def changes(self) -> AsyncIterator[str]:
        """Announced lines from this call on; ends when closed."""
        return self._lines(self._announcer.listen())

    async def _lines(self, queue: asyncio.Queue[str | None]) -> AsyncIterator[str]:
        try:
            while (line := await queue.get()) is not None:
                yield line
        finally:
            self._announcer.forget(queue)
