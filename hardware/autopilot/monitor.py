"""What is heard of one vehicle: snapshot, link, who has control. It asks for telemetry and commands nothing."""

from __future__ import annotations

import asyncio
import logging
import math
import time
from collections import deque
from collections.abc import AsyncIterator

from hardware.authority import Authority, ModeHeard, SticksTookOver, SwitchMoved
from hardware.autopilot.announcer import Announcer, Wakeup
from hardware.autopilot.ardupilot import ARDUPILOT
from hardware.autopilot.boot_clock import LastingOddity
from hardware.autopilot.commander import Commander
from hardware.autopilot.control import Control
from hardware.autopilot.dialect import STATION_NOTICED_LOST_S, Dialect
from hardware.autopilot.failsafe_names import FailsafeNames
from hardware.autopilot.link import Fields, MavlinkLink
from hardware.autopilot.messages import (
    HEARTBEAT_ID,
    HOME_POSITION_ID,
    RC_CHANNELS_ID,
    Outgoing,
    message_interval,
    request_message,
)
from hardware.autopilot.mode_switch import ModeSwitch
from hardware.autopilot.opening import Connection
from hardware.autopilot.px4 import PX4
from hardware.autopilot.remote_id import ARM_STATUS, RemoteId, remote_id
from hardware.autopilot.silence import AfterSilence, Silence
from hardware.autopilot.snapshot import NAMES, Snapshot
from hardware.autopilot.status_texts import StatusText, StatusTexts
from hardware.autopilot.timesync import Timesync
from hardware.deadline import Deadline
from hardware.ports import Clock, VehicleUnreachable
from hardware.readings import Announcement, Telemetry
from hardware.reasons.vehicle import HeartbeatStopped, UnknownAutopilot, VehicleNotConnected
from hardware.reasons.vehicle_news import (
    AutopilotRestarted,
    AutopilotSaid,
    ClockRateOdd,
    ModeChanged,
    PositionJumped,
    SwitchUndone,
    TakenOver,
    TakenOverBySticks,
    VehicleConnected,
    VehicleHeardAgain,
    VehicleNews,
    VehicleUnheard,
)
from planner.reason import text_of

log = logging.getLogger(__name__)

DIALECTS: dict[int, Dialect] = {12: PX4, 3: ARDUPILOT}
"""MAV_AUTOPILOT -> dialect."""
HEARTBEAT_WALL_S = 0.6
"""MAVSDK keeps the first one to itself; the next comes a second later, or when it is asked for."""
STREAMS: tuple[tuple[int, float], ...] = (
    (30, 20.0),  # ATTITUDE
    (33, 10.0),  # GLOBAL_POSITION_INT
    (245, 5.0),  # EXTENDED_SYS_STATE
    (24, 5.0),  # GPS_RAW_INT: a lost fix is noticed within half a second
    (1, 2.0),  # SYS_STATUS
    (230, 2.0),  # ESTIMATOR_STATUS (PX4)
    (193, 2.0),  # EKF_STATUS_REPORT (ArduPilot)
    (147, 1.0),  # BATTERY_STATUS
    (HOME_POSITION_ID, 0.5),
)
MODE_SWITCH_HZ, READ_ATTEMPTS = 5.0, 3
LINK_LOST_WALL_S = 3.0
UNANSWERED_FROM, UNANSWERED_TO = 0.5, 2.0
"""Shares of the autopilot's patience with a silent station: so long without an answer to our five questions a second,
it may act on hearing nothing. It counts from the last heartbeat, of one a second, so that some of its patience may be
gone with the last answer. A link that only loses much leaves no such gap; what has not answered for longer hears us."""
MODE_S = 0.2
"""Longer than this nothing waits for the vehicle's next word of its mode."""

SAID_KEPT = 30
"""The autopilot's last words, to find among them why it refused."""
STREAMS_CEASED_S = 3.0
AFTER_SILENCE_S, AFTER_SILENCE_WALL_S = 15.0, 5.0
"""For this long after it was heard again, or the server came back, a vehicle may still act on the silence before: it
hears us later than we hear it."""


class Monitor:
    """Everything one instance of MavsdkVehicle knows. Its parts are public to the manoeuvres of this package."""

    def __init__(self, url: str, clock: Clock, opened: Connection | None = None) -> None:
        self.clock = clock
        listened = (*NAMES, "COMMAND_ACK", "STATUSTEXT", "EVENT", "TIMESYNC", "PING", "RC_CHANNELS", ARM_STATUS)
        self.link = MavlinkLink(url, listened, self._on_message, opened)
        self.snapshot = Snapshot()
        self.remote_id = RemoteId()
        self._texts = StatusTexts()
        self._failsafe_names = FailsafeNames()
        self._said: deque[tuple[float, str]] = deque(maxlen=SAID_KEPT)
        self.wakeup = Wakeup()
        self.connected = False
        self._dialect: Dialect | None = None
        self._autopilot_number: int | None = None
        self._announcer = Announcer()
        self.control = Control(self._on_authority)
        self.timesync = Timesync(self.link, clock, self.snapshot)
        self.commander = Commander(
            self.link, clock, self.control, self.announce, self.mode_heard, lambda: self.timesync.quickest_s
        )
        self.silence = Silence()
        self.mode_switch = ModeSwitch()
        self.patience_s: float | None = None
        """How long a station is silent before the autopilot acts, by its own parameter; None: not read yet."""
        self._after_silence = AfterSilence(clock)
        self._lost_at_s: float | None = None
        self._shown_mode: int | None = None
        self._tasks: list[asyncio.Task[None]] = []

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
        asked_s = -math.inf
        while self._autopilot_number is None:
            now_s = time.monotonic()
            if now_s - started > timeout_s:
                raise VehicleUnreachable(HeartbeatStopped(self.link.url))
            if now_s - asked_s > HEARTBEAT_WALL_S:
                asked_s = now_s
                await self._send_once(request_message(HEARTBEAT_ID))
            await self.wakeup.wait()
        dialect = DIALECTS.get(self._autopilot_number)
        if dialect is None:
            raise VehicleUnreachable(UnknownAutopilot(self.link.url, self._autopilot_number))
        self._dialect = dialect
        self.connected = True
        self.announce(VehicleConnected(dialect.name, self.link.url))
        rates = (message_interval(message_id, hz) for message_id, hz in self._streams)
        for outgoing in (*rates, request_message(HOME_POSITION_ID)):
            await self._send_once(outgoing)  # whether they were heard is asked when the link is up
        first = Deadline(self.clock, 5.0, 3.0)
        while (self.snapshot.position is None or self.snapshot.in_air is None) and not first.passed:
            await self.wakeup.wait()
        self._on_mode()  # before anything is commanded it is known whether a pilot flies
        self._tasks = [
            asyncio.create_task(self._watch_link(), name="vehicle-link-watch"),
            asyncio.create_task(self._keep_streams(), name="vehicle-streams"),
            asyncio.create_task(self.timesync.run(), name="vehicle-timesync"),
        ]

    async def close(self) -> None:
        """Idempotent. The vehicle goes on with what it was commanded."""
        tasks, self._tasks = self._tasks, []
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        self.connected = False
        await self.link.close()
        self._announcer.end()

    @property
    def _streams(self) -> tuple[tuple[int, float], ...]:
        switch = () if self.mode_switch.channel is None else ((RC_CHANNELS_ID, MODE_SWITCH_HZ),)
        return (self.dialect.mode_report, *STREAMS, *switch)

    async def _send_once(self, outgoing: Outgoing) -> None:
        """A command that moves nothing, without waiting for its answer."""
        await self.link.send(outgoing.message, outgoing.fields, lambda: True)

    async def _request_streams(self) -> None:
        for message_id, hz in self._streams:
            if not await self.commander.ask(message_interval(message_id, hz)):
                log.info("the autopilot does not stream MAVLink message %d", message_id)
        await self.commander.ask(request_message(HOME_POSITION_ID))

    async def _keep_streams(self) -> None:
        """Make sure of the telemetry rates; ask for them again when the autopilot has forgotten them."""
        await self._request_streams()
        await self._find_mode_switch()
        self.patience_s = await self._read(self.dialect.station_time) or self.patience_s
        reboots, oddity = self.snapshot.reboots, LastingOddity()
        while True:
            await asyncio.sleep(1.0)
            stays_odd = oddity.look(self.snapshot.clock_rate_is_odd)
            if stays_odd and not self.snapshot.clock_stays_odd:
                self.announce(ClockRateOdd(self.snapshot.clock_rate or 1.0))
            self.snapshot.clock_stays_odd = stays_odd
            attitude = self.snapshot.attitude_heard_at_s
            ceased = attitude is None or self.clock.now() - attitude > STREAMS_CEASED_S
            if self.snapshot.reboots != reboots:
                reboots = self.snapshot.reboots
                self.announce(AutopilotRestarted())
            elif not ceased or self.silence.seconds > LINK_LOST_WALL_S:
                if self.snapshot.home is None:
                    await self.commander.ask(request_message(HOME_POSITION_ID))
                continue
            await self._request_streams()

    async def _find_mode_switch(self) -> None:
        """Which of the transmitter's channels selects modes."""
        if number := await self._read(self.dialect.mode_switch):
            self.mode_switch.channel = int(number)
            await self.commander.ask(message_interval(RC_CHANNELS_ID, MODE_SWITCH_HZ))

    async def _read(self, parameter: str) -> float | None:
        """Asked again of a link that loses much."""
        for _ in range(READ_ATTEMPTS):
            if (value := await self.link.parameter(parameter)) is not None:
                return value
        return None

    async def _watch_link(self) -> None:
        looked = time.monotonic()
        while True:
            await asyncio.sleep(0.1)
            before, looked = looked, time.monotonic()
            self.look_at_link(looked - before)

    def look_at_link(self, elapsed_s: float) -> None:
        """Is the vehicle still heard? elapsed_s: of wall time, since the last look."""
        for text in self._texts.overdue(self.clock.now()):
            self._say(text, self.clock.now())
        if self.mode_switch.take_moved(self.clock.now()):
            self.control.see(SwitchMoved(self.telemetry().mode or "", self.clock.now()))
        self.silence.look(elapsed_s)
        if self._hears_us_no_more(elapsed_s):
            self._begin_after_silence()
        self._after_silence.look()
        lost = self.silence.seconds > LINK_LOST_WALL_S
        if lost and self.connected:
            self.connected, self._lost_at_s = False, self.snapshot.heard_at_s
            self.snapshot.forget_landed()
            self.announce(VehicleUnheard())
            self.wakeup.wake()
        elif not lost and not self.connected and self._heartbeat_heard_again:
            self.connected = True
            self._begin_after_silence()
            outage = self.clock.now() - (self._lost_at_s or self.clock.now())
            self.announce(VehicleHeardAgain(outage))
            self.wakeup.wake()

    def _hears_us_no_more(self, elapsed_s: float) -> bool:
        """It may be heard all the same, from a radio that is stronger than ours; its failsafe acts on that alone."""
        unanswered = self.timesync.unanswered
        if unanswered is None:
            return False
        unanswered.look(elapsed_s)
        least_s, most_s = STATION_NOTICED_LOST_S if self.patience_s is None else (self.patience_s, self.patience_s)
        return UNANSWERED_FROM * least_s < unanswered.seconds < UNANSWERED_TO * most_s

    @property
    def _heartbeat_heard_again(self) -> bool:
        """Before anything is commanded after a silence, what the vehicle did meanwhile is known: mode and arming."""
        return (self.snapshot.heartbeat_at_s or -math.inf) > (self._lost_at_s or -math.inf)

    def _on_message(self, name: str, fields: Fields) -> None:
        now = self.clock.now()
        self.silence.heard()
        if name == "COMMAND_ACK":
            self.commander.acknowledged(fields)
        elif name == "TIMESYNC":
            self.timesync.heard(fields, now)
        elif name == "PING":
            self.timesync.came_back(fields, now)
        elif name == "STATUSTEXT":
            self._on_text(fields, now)
        elif name == "EVENT" and self._dialect is not None:
            self.control.named(self._failsafe_names.event(self._dialect.failsafe_words, fields, now), now)
        elif name == "RC_CHANNELS":
            self.mode_switch.see(fields, now)
        elif name == ARM_STATUS:
            self.remote_id = remote_id(int(fields["status"]), str(fields["error"]), now)
        else:
            if name == "HEARTBEAT":
                self._autopilot_number = int(fields["autopilot"])
            self.snapshot.fold(name, fields, now)
            if name == "GLOBAL_POSITION_INT" and self.snapshot.jumped_m is not None:
                self.announce(PositionJumped(self.snapshot.jumped_m))
            if name in ("HEARTBEAT", "CURRENT_MODE", "EXTENDED_SYS_STATE"):
                self._on_mode(fields.get("system_status"))
        self.wakeup.wake()

    async def mode_heard(self, longest_s: float = MODE_S) -> None:
        """Until the vehicle's next word of its mode, which it gives at once when the mode has changed."""
        known_at_s, deadline = self.snapshot.mode_at_s, Deadline(self.clock, longest_s, longest_s)
        while self.snapshot.mode_at_s == known_at_s and not deadline.passed:
            await self.wakeup.wait()

    def _on_text(self, fields: Fields, now_s: float) -> None:
        text, chunk = str(fields["text"]), int(fields.get("chunk_seq", 0))
        dialect = self._dialect
        if dialect is not None and chunk == 0:
            if dialect.takeover_text and text.startswith(dialect.takeover_text):
                self.control.see(SticksTookOver(now_s))
            self.control.named(self._failsafe_names.text(dialect.failsafe_words, text, now_s), now_s)
        for whole in self._texts.take(int(fields["severity"]), text, int(fields.get("id", 0)), chunk, now_s):
            self._say(whole, now_s)

    def _say(self, text: StatusText, now_s: float) -> None:
        if text.severity == "information":
            log.info("autopilot: %s", text.text)
            return
        self._said.append((now_s, text.text))
        self.announce(AutopilotSaid(text.severity, text.text))

    def said_since(self, at_s: float) -> list[str]:
        """The autopilot's warnings and errors from then on, each once, oldest first."""
        return list(dict.fromkeys(text for said_at_s, text in self._said if said_at_s >= at_s))

    def _on_mode(self, state: int | None = None) -> None:
        """state: MAV_STATE of the heartbeat that told the mode, if one did."""
        snapshot = self.snapshot
        mode = snapshot.custom_mode
        if mode is None or snapshot.armed is None or self._dialect is None:
            return
        if mode != self._shown_mode:
            if self._shown_mode is not None:
                self.announce(ModeChanged(self._dialect.mode_name(mode)))
            self._shown_mode = mode
        arming_known = self.connected or self._heartbeat_heard_again
        self.control.see(
            ModeHeard(
                mode=mode,
                kind=self._dialect.mode_kind(mode),
                name=self._dialect.mode_name(mode),
                armed=snapshot.armed if arming_known else None,
                in_air=bool(snapshot.in_air),
                after_silence=self._after_silence.look() or not self.connected,
                at_s=snapshot.mode_at_s or self.clock.now(),
                acts=self._dialect.failsafe_acts(state, snapshot.tells_current_mode),
                waits_again=self._dialect.waits_again,
            )
        )

    def restore(self, authority: Authority) -> None:
        """Go on from who flew before the server restarted; what the vehicle says now is judged by that."""
        self._begin_after_silence()
        self.control.restore(authority)
        self._on_mode()

    def _begin_after_silence(self) -> None:
        self._after_silence.begin(AFTER_SILENCE_S, AFTER_SILENCE_WALL_S)

    def _on_authority(self, before: Authority, after: Authority) -> None:
        if after.who != before.who and after.who in ("pilot", "failsafe"):
            by_sticks = after.taken_by == "sticks"
            self.announce(TakenOverBySticks() if by_sticks else TakenOver(after.who, after.mode or ""))
        if after.undone and not before.undone and self._dialect is not None:
            self.announce(SwitchUndone(self._dialect.mode_name(after.heard or 0)))
        self.wakeup.wake()

    def announce(self, news: VehicleNews) -> None:
        """To the log and to every listener, stamped with the mission's clock."""
        log.info("%s", text_of(news))
        self._announcer.say(Announcement(self.clock.now(), news))

    @property
    def dialect(self) -> Dialect:
        """Raises VehicleUnreachable before an autopilot was heard."""
        self.check_connected()
        assert self._dialect is not None
        return self._dialect

    def check_connected(self) -> None:
        """Raises VehicleUnreachable before an autopilot was heard (a link that was lost since is no matter)."""
        if self._dialect is None:
            raise VehicleUnreachable(VehicleNotConnected(self.link.url))

    def telemetry(self) -> Telemetry:
        """The latest of everything; None where nothing was heard yet. Never blocks."""
        mode, dialect = self.snapshot.custom_mode, self._dialect
        return self.snapshot.telemetry(
            self.clock.now(),
            self.connected,
            None if mode is None or dialect is None else dialect.mode_name(mode),
            self.control.authority,
            "unknown" if dialect is None else dialect.name,
        )

    def changes(self) -> AsyncIterator[Announcement]:
        """What is announced from this call on; ends when closed."""
        return self._announced(self._announcer.listen())

    async def _announced(self, queue: asyncio.Queue[Announcement | None]) -> AsyncIterator[Announcement]:
        try:
            while (announcement := await queue.get()) is not None:
                yield announcement
        finally:
            self._announcer.forget(queue)
