"""The Vehicle port over MAVSDK. Acknowledgement is not success: every deed is confirmed by telemetry."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import math
import time
from collections.abc import AsyncIterator, Callable

from hardware.autopilot.ardupilot import ARDUPILOT
from hardware.autopilot.commander import Commander, CommandRefused, Manoeuvre
from hardware.autopilot.control import ControlLatch
from hardware.autopilot.dialect import Dialect, FailsafeRule, ModeOrder
from hardware.autopilot.ground import distance_m
from hardware.autopilot.link import Fields, MavlinkLink
from hardware.autopilot.messages import (
    CHANGE_SPEED,
    HOME_POSITION_ID,
    arm,
    command_long,
    message_interval,
    reposition,
    request_message,
    set_mode,
)
from hardware.autopilot.patience import Announcer, Deadline, News
from hardware.autopilot.preflight import failsafe_checks, telemetry_checks
from hardware.autopilot.px4 import PX4
from hardware.autopilot.snapshot import NAMES, Snapshot
from hardware.autopilot.turn import TurnManoeuvre
from hardware.ports import Clock, VehicleError, VehicleUnreachable
from hardware.readings import GeoPoint, HeadingSample, PreflightCheck, Telemetry

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
LINK_LOST_S, LINK_LOST_WALL_S = 3.0, 1.5
GIVE_UP_LINK_S, GIVE_UP_LINK_WALL_S = 15.0, 5.0
"""A manoeuvre whose vehicle is silent for so long ends with VehicleUnreachable (the vehicle flies on by itself)."""
ARRIVED_M, SETTLED_M_S, SETTLED_FOR_S = 2.0, 1.0, 1.0
STUCK_S = 10.0


class MavsdkVehicle:
    """A PX4 or ArduCopter multicopter. Build one an URL; `connect` before anything else."""

    def __init__(self, url: str, clock: Clock, minimum_battery_percent: float = 30.0) -> None:
        self._clock = clock
        self._minimum_battery_percent = minimum_battery_percent
        self._link = MavlinkLink(url, (*NAMES, "COMMAND_ACK", "STATUSTEXT"), self._on_message)
        self._snapshot = Snapshot()
        self._dialect: Dialect | None = None
        self._autopilot_number: int | None = None
        self._latch = ControlLatch(frozenset(), self._mode_name)
        self._announcer = Announcer()
        self._news = News()
        self._commander = Commander(self._link, clock, self._latch, self._announce)
        self._manoeuvre: Manoeuvre | None = None
        self._station: tuple[GeoPoint, float] | None = None
        self._heard_wall = -math.inf
        self._connected = False
        self._lost_at_s: float | None = None
        self._shown_mode: int | None = None
        self._tasks: list[asyncio.Task[None]] = []

    # -- life ------------------------------------------------------------------------------------------------------

    async def connect(self, timeout_s: float = 30.0) -> None:
        """Open the link and wait for an autopilot (wall seconds). Raises VehicleUnreachable."""
        try:
            await self._connect(timeout_s)
        except BaseException:
            await self.close()
            raise

    async def _connect(self, timeout_s: float) -> None:
        started = time.monotonic()
        await self._link.open(timeout_s)
        while self._autopilot_number is None:
            if time.monotonic() - started > timeout_s:
                raise VehicleUnreachable(f"An autopilot was there on {self._link.url}, but its heartbeat stopped.")
            await self._news.wait()
        dialect = DIALECTS.get(self._autopilot_number)
        if dialect is None:
            raise VehicleUnreachable(
                f"The autopilot on {self._link.url} is neither PX4 nor ArduPilot "
                f"(MAV_AUTOPILOT {self._autopilot_number})."
            )
        self._dialect = dialect
        self._latch = ControlLatch(dialect.calm, self._mode_name)
        self._commander = Commander(self._link, self._clock, self._latch, self._announce)
        self._connected = True
        self._announce(f"connected to {dialect.name} on {self._link.url}")
        await self._request_streams()
        first = Deadline(self._clock, 5.0, 3.0)
        while self._snapshot.position is None and not first.passed:
            await self._news.wait()
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
        self._connected = False
        await self._link.close()
        self._announcer.end()

    async def _request_streams(self) -> None:
        for message_id, hz in STREAMS:
            if not await self._commander.ask(message_interval(message_id, hz)):
                log.info("the autopilot does not stream MAVLink message %d", message_id)
        await self._commander.ask(request_message(HOME_POSITION_ID))

    async def _keep_streams(self) -> None:
        """Ask for the telemetry rates again when the autopilot has forgotten them."""
        reboots = self._snapshot.reboots
        while True:
            await asyncio.sleep(1.0)
            attitude = self._snapshot.attitude_heard_at_s
            ceased = attitude is None or self._clock.now() - attitude > LINK_LOST_S
            if self._snapshot.reboots != reboots:
                reboots = self._snapshot.reboots
                self._announce("the autopilot has started anew")
            elif not (self._connected and ceased):
                continue
            await self._request_streams()

    async def _watch_link(self) -> None:
        while True:
            await asyncio.sleep(0.1)
            silent = self._clock.now() - (self._snapshot.heard_at_s or -math.inf)
            lost = silent > LINK_LOST_S and time.monotonic() - self._heard_wall > LINK_LOST_WALL_S
            if lost and self._connected:
                self._connected, self._lost_at_s = False, self._snapshot.heard_at_s
                self._announce("vehicle link lost")
                self._news.tell()
            elif not lost and not self._connected:
                self._connected = True
                outage = self._clock.now() - (self._lost_at_s or self._clock.now())
                self._announce(f"vehicle link restored after {outage:.1f} s")
                self._news.tell()

    # -- what is heard ---------------------------------------------------------------------------------------------

    def _on_message(self, name: str, fields: Fields) -> None:
        now = self._clock.now()
        self._heard_wall = time.monotonic()
        if name == "COMMAND_ACK":
            self._commander.acknowledged(fields)
        elif name == "STATUSTEXT":
            self._on_text(str(fields["text"]).rstrip("\x00\t "))
        else:
            if name == "HEARTBEAT":
                self._autopilot_number = int(fields["autopilot"])
            self._snapshot.fold(name, fields, now)
            if name == "GLOBAL_POSITION_INT" and self._snapshot.jumped_m is not None:
                self._announce(f"GPS position jumped by {self._snapshot.jumped_m:.0f} m")
            if name in ("HEARTBEAT", "CURRENT_MODE", "EXTENDED_SYS_STATE"):
                self._on_mode()
        self._news.tell()

    def _on_text(self, text: str) -> None:
        log.info("autopilot: %s", text)
        if text.startswith("Pilot took over") and self._latch.reason is None and self._snapshot.armed:
            self._take_over(self._latch.latch("the pilot took over using the sticks"))

    def _on_mode(self) -> None:
        snapshot = self._snapshot
        mode = snapshot.custom_mode
        if mode is None or snapshot.armed is None:
            return
        if mode != self._shown_mode:
            if self._shown_mode is not None:
                self._announce(f"mode {self._mode_name(mode)}")
            self._shown_mode = mode
        reason = self._latch.observe(mode, snapshot.armed, bool(snapshot.in_air))
        if reason is not None:
            self._take_over(reason)

    def _take_over(self, reason: str) -> None:
        self._announce(f"pilot took over: {reason}")
        self._news.tell()

    def _announce(self, line: str) -> None:
        log.info("vehicle: %s", line)
        self._announcer.say(line)

    def _mode_name(self, custom_mode: int) -> str:
        return f"mode {custom_mode}" if self._dialect is None else self._dialect.mode_name(custom_mode)

    # -- what is shown ---------------------------------------------------------------------------------------------

    def telemetry(self) -> Telemetry:
        """The latest snapshot; never blocks."""
        mode = self._snapshot.custom_mode
        return self._snapshot.telemetry(
            self._clock.now(),
            self._connected,
            None if mode is None else self._mode_name(mode),
            self._latch.controller,
            "unknown" if self._dialect is None else self._dialect.name,
        )

    def headings(self, since_s: float) -> list[HeadingSample]:
        """Every heading heard at or after `since_s`, in time order (the last five minutes)."""
        return self._snapshot.headings(since_s)

    def changes(self) -> AsyncIterator[str]:
        """A line whenever control, mode or link changes, or a command has to be repeated. From the call on."""
        return self._lines(self._announcer.listen())

    async def _lines(self, queue: asyncio.Queue[str | None]) -> AsyncIterator[str]:
        try:
            while (line := await queue.get()) is not None:
                yield line
        finally:
            self._announcer.forget(queue)

    async def preflight(self) -> list[PreflightCheck]:
        """Checks of link, GPS, heading, battery, home, readiness and failsafe parameters, with remedies."""
        dialect = self._speaks()
        checks = telemetry_checks(
            self.telemetry(), self._snapshot.prearm_ok, self._latch.reason, self._minimum_battery_percent
        )
        values = {rule.parameter: (await self._failsafe(rule))[1] for rule in dialect.failsafes}
        return checks + failsafe_checks(dialect, values)

    async def _failsafe(self, rule: FailsafeRule) -> tuple[str, float | None]:
        """(the name this version has, its value or None)."""
        value = await self._link.parameter(rule.parameter)
        if value is None and rule.formerly is not None:
            return rule.formerly, await self._link.parameter(rule.formerly)
        return rule.parameter, value

    async def mend_failsafes(self) -> list[str]:
        """Set every failsafe parameter that would not act to its remedy. Only on the operator's explicit wish."""
        done: list[str] = []
        for rule in self._speaks().failsafes:
            name, value = await self._failsafe(rule)
            if value is None or rule.holds(value):
                continue
            wanted = rule.set_to if rule.bit is None else int(value) | rule.bit
            if not await self._link.set_parameter(name, wanted):
                raise VehicleError(f"The autopilot did not take {name} = {wanted}. {rule.remedy}")
            done.append(f"{name} set from {value:g} to {wanted}")
            self._announce(done[-1])
        return done

    def release_pilot_latch(self) -> None:
        """The operator's explicit deed that lets commands pass again after a pilot took over."""
        if self._latch.reason is not None:
            self._latch.release()
            self._announce("control released by the operator")

    # -- manoeuvres ------------------------------------------------------------------------------------------------

    def _speaks(self) -> Dialect:
        if self._dialect is None:
            raise VehicleUnreachable(f"No vehicle is connected on {self._link.url}.")
        return self._dialect

    def _begin(self, name: str) -> Manoeuvre:
        """Supersede what is going on. A second hold joins the first."""
        if self._manoeuvre is not None:
            if self._manoeuvre.name == name == "Hold" and self._manoeuvre.superseded_by is None:
                return self._manoeuvre
            self._manoeuvre.superseded_by = name
        self._manoeuvre = manoeuvre = Manoeuvre(name)
        self._news.tell()
        self._commander.check(manoeuvre)
        return manoeuvre

    def _go_on(self, manoeuvre: Manoeuvre) -> None:
        """Raises when the manoeuvre may not go on, or its vehicle has been silent for too long."""
        self._commander.check(manoeuvre)
        silent = self._clock.now() - (self._snapshot.heard_at_s or -math.inf)
        silent_wall = time.monotonic() - self._heard_wall
        if not self._connected and silent > GIVE_UP_LINK_S and silent_wall > GIVE_UP_LINK_WALL_S:
            raise VehicleUnreachable(f"{manoeuvre.name}: nothing heard from the vehicle for {silent:.0f} s.")

    async def _until(self, manoeuvre: Manoeuvre, deadline: Deadline, happened: Callable[[], bool]) -> bool:
        """True once it happened, False when the deadline passed."""
        while True:
            self._go_on(manoeuvre)
            if happened():
                return True
            if deadline.passed:
                return False
            await self._news.wait()

    async def _select(self, manoeuvre: Manoeuvre, order: ModeOrder) -> None:
        """Select a mode and see it; what is not seen is ordered again."""
        for attempt in range(1, 4):
            await self._commander.order(manoeuvre, set_mode(order.custom), order.modes, f"mode {order.name}")
            seen = Deadline(self._clock, 3.0, 1.5)
            if await self._until(manoeuvre, seen, lambda: self._snapshot.custom_mode in order.modes):
                return
            if attempt < 3:
                self._announce(f"mode {order.name} acknowledged but not seen, ordered again ({attempt + 1} of 3)")
        raise VehicleError(f"The autopilot acknowledged mode {order.name} three times and never showed it.")

    async def hold(self) -> None:
        """Brake and hover, at any time; a flight or turn in progress ends with an error. Returns once it hovers."""
        dialect = self._speaks()
        manoeuvre = self._begin("Hold")
        if not self._snapshot.armed:
            return

        def hovers() -> bool:
            speed = self._snapshot.speed_m_s
            return self._snapshot.custom_mode in dialect.hold_modes and speed is not None and speed < SETTLED_M_S

        trouble = ""
        for number, outgoing in enumerate(dialect.hold, 1):
            try:
                await self._commander.order(manoeuvre, outgoing, dialect.hold_modes, "hold")
                if await self._until(manoeuvre, Deadline(self._clock, 10.0, 2.0), hovers):
                    return
                trouble = "hold was acknowledged but the vehicle does not hover"
            except CommandRefused as refusal:
                trouble = str(refusal)
            if number < len(dialect.hold):
                self._announce(f"{trouble}, ordered again ({number + 1} of {len(dialect.hold)})")
        raise VehicleError(f"{trouble}. The pilot should take over.")

    async def return_home(self) -> None:
        """Start the autopilot's own return; returns once its mode confirms."""
        dialect = self._speaks()
        self._refuse_on_ground("return home")
        await self._select(self._begin("Return"), dialect.return_home)

    async def land(self) -> None:
        """Start landing on the spot; returns once the mode confirms."""
        dialect = self._speaks()
        self._refuse_on_ground("land")
        await self._select(self._begin("Landing"), dialect.land)

    def _refuse_on_ground(self, what: str) -> None:
        if not self._snapshot.armed:
            raise VehicleError(f"The vehicle is on the ground and not armed: there is nothing to {what} from.")

    async def take_off(self, altitude_relative_m: float) -> None:
        """Arm, take off and climb; in the air already: climb or descend there. Confirmed by altitude."""
        dialect = self._speaks()
        if not (math.isfinite(altitude_relative_m) and altitude_relative_m > 0):
            raise ValueError(f"The take-off altitude must be metres above home, above zero, not {altitude_relative_m}.")
        amsl, relative, place = (
            self._snapshot.altitude_amsl_m,
            self._snapshot.altitude_relative_m,
            self._snapshot.position,
        )
        if amsl is None or relative is None or place is None:
            raise VehicleError("The vehicle does not know its position yet: wait for GPS, then take off.")
        target_amsl = amsl + altitude_relative_m - relative
        if self._snapshot.armed and self._snapshot.in_air:
            await self.goto(place, target_amsl, 5.0)
            return
        manoeuvre = self._begin("Take-off")
        try:
            await self._leave_ground(manoeuvre, dialect, altitude_relative_m, target_amsl)
        finally:
            if not self._snapshot.armed:
                self._latch.stand_down()
        slack = max(1.0, 0.03 * altitude_relative_m)

        def climbed() -> bool:
            up, velocity = self._snapshot.altitude_relative_m, self._snapshot.velocity_ned
            level = velocity is not None and abs(velocity[2]) < 0.5
            settled = self._snapshot.custom_mode in dialect.settled_modes
            return up is not None and up > altitude_relative_m - slack and level and settled

        if not await self._until(manoeuvre, Deadline(self._clock, 30.0 + altitude_relative_m / 0.5), climbed):
            raise VehicleError(
                f"The vehicle climbed to {self._snapshot.altitude_relative_m:.1f} m only, "
                f"not {altitude_relative_m:.1f} m."
            )
        self._station = (self._snapshot.position or place, target_amsl)

    async def _leave_ground(self, manoeuvre: Manoeuvre, dialect: Dialect, relative_m: float, amsl_m: float) -> None:
        """Mode, arm and take-off are tried together: an autopilot disarms while one waits between them."""
        deadline, trouble = Deadline(self._clock, 60.0, 5.0), "nothing tried"
        while not deadline.passed:
            try:
                await self._select(manoeuvre, dialect.before_take_off)
                if not self._snapshot.armed:
                    await self._commander.order(manoeuvre, arm(), dialect.take_off_modes, "arming")
                take_off = dialect.take_off(relative_m, amsl_m)
                await self._commander.order(manoeuvre, take_off, dialect.take_off_modes, "take-off")
                if await self._until(manoeuvre, Deadline(self._clock, 10.0, 2.0), lambda: self._rising(relative_m)):
                    return
                trouble = "take-off was acknowledged but the vehicle stayed on the ground"
            except CommandRefused as refusal:
                trouble = str(refusal)
            self._announce(f"take-off tried again: {trouble}")
            await self._until(manoeuvre, Deadline(self._clock, 2.0, 0.2), lambda: False)
        raise VehicleError(f"No take-off within 60 s: {trouble}")

    def _rising(self, target_m: float) -> bool:
        up = self._snapshot.altitude_relative_m
        return bool(self._snapshot.armed) and up is not None and up > min(1.0, 0.5 * target_m)

    # -- flying ----------------------------------------------------------------------------------------------------

    async def goto(self, place: GeoPoint, altitude_amsl_m: float, speed_m_s: float) -> None:
        """Fly there and return once telemetry says arrived and settled."""
        dialect = self._speaks()
        numbers = (place.lat_deg, place.lon_deg, altitude_amsl_m, speed_m_s)
        if (
            not all(map(math.isfinite, numbers))
            or speed_m_s <= 0
            or abs(place.lat_deg) > 90
            or abs(place.lon_deg) > 180
        ):
            raise ValueError(f"No place to fly to: {place}, {altitude_amsl_m} m AMSL at {speed_m_s} m/s.")
        if not (self._snapshot.armed and self._snapshot.in_air):
            raise VehicleError("The vehicle is not in the air: take off first.")
        manoeuvre = self._begin("Flight")
        distance, climb = self._distance(place, altitude_amsl_m)
        deadline = Deadline(self._clock, 30.0 + 3.0 * distance / speed_m_s + climb / 0.5)
        for attempt in range(1, 4):
            await self._commander.order(
                manoeuvre,
                reposition(place, altitude_amsl_m, speed_m_s, None),
                dialect.reposition_modes,
                "the next place",
            )
            self._station = (place, altitude_amsl_m)
            if not dialect.reposition_sets_speed:
                speed = command_long(CHANGE_SPEED, 1.0, speed_m_s, -1.0, 0.0, 0.0, 0.0, 0.0)
                with contextlib.suppress(CommandRefused):
                    await self._commander.order(manoeuvre, speed, dialect.reposition_modes, "the speed")
            if await self._arrive(manoeuvre, place, altitude_amsl_m, deadline):
                return
            distance, climb = self._distance(place, altitude_amsl_m)
            if deadline.passed:
                break
            if attempt < 3:
                self._announce(
                    f"no progress for {STUCK_S:.0f} s with {distance:.0f} m to go, "
                    f"place sent again ({attempt + 1} of 3)"
                )
        raise VehicleError(
            f"The vehicle did not arrive: still {distance:.1f} m and {climb:.1f} m of height from the place."
        )

    def _distance(self, place: GeoPoint, altitude_amsl_m: float) -> tuple[float, float]:
        """(horizontal, vertical) metres to go, infinite while nothing was heard."""
        here, amsl = self._snapshot.position, self._snapshot.altitude_amsl_m
        if here is None or amsl is None:
            return math.inf, math.inf
        return distance_m(here, place), abs(altitude_amsl_m - amsl)

    async def _arrive(self, manoeuvre: Manoeuvre, place: GeoPoint, altitude_amsl_m: float, deadline: Deadline) -> bool:
        """True when arrived and settled; False when no progress was seen for STUCK_S, or the deadline passed.

        Both are measured in the time of the positions seen, so that a silent link is no lack of progress.
        """
        nearest, progress_at = sum(self._distance(place, altitude_amsl_m)), self._snapshot.position_at_s or 0.0
        settled_since: float | None = None
        while not deadline.passed:
            self._go_on(manoeuvre)
            distance, climb = self._distance(place, altitude_amsl_m)
            speed, seen_at = self._snapshot.speed_m_s, self._snapshot.position_at_s or 0.0
            inside = distance < ARRIVED_M and climb < ARRIVED_M
            if inside and speed is not None and speed < SETTLED_M_S:
                settled_since = seen_at if settled_since is None else settled_since
                if seen_at - settled_since >= SETTLED_FOR_S:
                    return True
            else:
                settled_since = None
            if inside or distance + climb < nearest - 1.0:
                nearest, progress_at = min(nearest, distance + climb), seen_at
            if seen_at - progress_at > STUCK_S:
                return False
            await self._news.wait()
        return False

    async def turn(self, rate_deg_s: float) -> None:
        """Turn once through 360 degrees on the spot; returns once telemetry has seen the whole circle."""
        dialect = self._speaks()
        if not (math.isfinite(rate_deg_s) and 1.0 <= rate_deg_s <= 180.0):
            raise ValueError(f"The turn rate must be 1 to 180 degrees a second, not {rate_deg_s}.")
        if not (self._snapshot.armed and self._snapshot.in_air):
            raise VehicleError("The vehicle is not in the air: take off first.")
        place, amsl = self._spot()
        turn = TurnManoeuvre(
            self._begin("Turn"),
            self._commander,
            self._clock,
            self._snapshot,
            self._news,
            self._go_on,
            dialect,
            rate_deg_s,
        )
        methods = dialect.turn_methods
        for number, method in enumerate(methods, 1):
            if await turn.run(method, place, amsl):
                return
            if number < len(methods):
                self._announce(
                    f"the turn stopped after {turn.turned_deg:.0f} degrees, tried again by "
                    f"{methods[number].replace('_', ' ')} ({number + 1} of {len(methods)})"
                )
        raise VehicleError(
            f"The vehicle acknowledged the turn and did not make it: {turn.turned_deg:.0f} degrees seen, "
            f"{len(methods)} ways tried."
        )

    def _spot(self) -> tuple[GeoPoint, float]:
        """Where to turn: the place flown to when the vehicle is there, else where it is."""
        here, amsl = self._snapshot.position, self._snapshot.altitude_amsl_m
        if here is None or amsl is None:
            raise VehicleError("The vehicle's position is not known: it cannot turn on the spot.")
        if self._station is not None and sum(self._distance(*self._station)) < 5.0:
            return self._station
        return here, amsl
