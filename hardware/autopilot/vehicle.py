"""The Vehicle port over MAVSDK. Acknowledgement is not success: every deed is confirmed by telemetry."""

from __future__ import annotations

import math
from collections.abc import AsyncIterator

from hardware.autopilot.commander import CommandRefused
from hardware.autopilot.dialect import FailsafeRule
from hardware.autopilot.flight import SETTLED_M_S, fly_to
from hardware.autopilot.helm import Helm
from hardware.autopilot.monitor import Monitor
from hardware.autopilot.patience import Deadline
from hardware.autopilot.preflight import failsafe_checks, telemetry_checks
from hardware.autopilot.take_off import take_off
from hardware.autopilot.turn import turn_around
from hardware.ports import Clock, VehicleError
from hardware.readings import GeoPoint, HeadingSample, PreflightCheck, Telemetry


class MavsdkVehicle:
    """A PX4 or ArduCopter multicopter. `connect` before anything else; after `close` make a new one.

    A cancelled manoeuvre sends nothing more; the vehicle ends what it was told last. `hold` stops it.
    """

    def __init__(self, url: str, clock: Clock, minimum_battery_percent: float = 30.0) -> None:
        self._monitor = Monitor(url, clock)
        self._helm = Helm(self._monitor)
        self._minimum_battery_percent = minimum_battery_percent

    async def connect(self, timeout_s: float = 30.0) -> None:
        """Open the link and wait for an autopilot (wall seconds). Raises VehicleUnreachable."""
        await self._monitor.connect(timeout_s)

    async def close(self) -> None:
        """Idempotent. The vehicle goes on with what it was told."""
        await self._monitor.close()

    # -- what is heard ---------------------------------------------------------------------------------------------

    def telemetry(self) -> Telemetry:
        """The latest snapshot; never blocks."""
        return self._monitor.telemetry()

    def headings(self, since_s: float) -> list[HeadingSample]:
        """Every heading heard at or after `since_s`, in time order (the last five minutes)."""
        return self._monitor.snapshot.headings(since_s)

    def changes(self) -> AsyncIterator[str]:
        """A line whenever control, mode or link changes, or a command has to be repeated. From the call on."""
        return self._monitor.changes()

    async def preflight(self) -> list[PreflightCheck]:
        """Checks of link, GPS, heading, battery, home, readiness and failsafe parameters, with remedies."""
        dialect, monitor = self._monitor.dialect, self._monitor
        checks = telemetry_checks(
            self.telemetry(), monitor.snapshot.prearm_ok, monitor.latch.reason, self._minimum_battery_percent
        )
        values = {rule.parameter: (await self._failsafe(rule))[1] for rule in dialect.failsafes}
        return checks + failsafe_checks(dialect, values)

    async def _failsafe(self, rule: FailsafeRule) -> tuple[str, float | None]:
        """(the name this version has, its value or None)."""
        link = self._monitor.link
        value = await link.parameter(rule.parameter)
        if value is None and rule.formerly is not None:
            return rule.formerly, await link.parameter(rule.formerly)
        return rule.parameter, value

    async def mend_failsafes(self) -> list[str]:
        """Set every failsafe parameter that would not act to its remedy. Only on the operator's explicit wish."""
        done: list[str] = []
        for rule in self._monitor.dialect.failsafes:
            name, value = await self._failsafe(rule)
            if value is None or rule.holds(value):
                continue
            wanted = rule.set_to if rule.bit is None else int(value) | rule.bit
            if not await self._monitor.link.set_parameter(name, wanted):
                raise VehicleError(f"The autopilot did not take {name} = {wanted}. {rule.remedy}")
            done.append(f"{name} set from {value:g} to {wanted}")
            self._monitor.announce(done[-1])
        return done

    def release_pilot_latch(self) -> None:
        """The operator's explicit deed that lets commands pass again after a pilot took over."""
        if self._monitor.latch.reason is not None:
            self._monitor.latch.release()
            self._monitor.announce("control released by the operator")

    # -- manoeuvres ------------------------------------------------------------------------------------------------

    async def take_off(self, altitude_relative_m: float) -> None:
        """Arm, take off and climb; in the air already: climb or descend there. Confirmed by altitude."""
        if not (math.isfinite(altitude_relative_m) and altitude_relative_m > 0):
            raise ValueError(f"The take-off altitude must be metres above home, above zero, not {altitude_relative_m}.")
        snapshot = self._monitor.snapshot
        if snapshot.armed and snapshot.in_air:
            place, amsl = self._helm.here()
            await self.goto(place, amsl + altitude_relative_m - (snapshot.altitude_relative_m or 0.0), 5.0)
        else:
            await take_off(self._helm, altitude_relative_m)

    async def goto(self, place: GeoPoint, altitude_amsl_m: float, speed_m_s: float) -> None:
        """Fly there and return once telemetry says arrived and settled."""
        numbers = (place.lat_deg, place.lon_deg, altitude_amsl_m, speed_m_s)
        off_earth = abs(place.lat_deg) > 90 or abs(place.lon_deg) > 180
        if not all(map(math.isfinite, numbers)) or speed_m_s <= 0 or off_earth:
            raise ValueError(f"No place to fly to: {place}, {altitude_amsl_m} m AMSL at {speed_m_s} m/s.")
        self._refuse_on_ground("take off first")
        await fly_to(self._helm, place, altitude_amsl_m, speed_m_s)

    async def turn(self, rate_deg_s: float) -> None:
        """Turn once through 360 degrees on the spot; returns once telemetry has seen the whole circle."""
        if not (math.isfinite(rate_deg_s) and 1.0 <= rate_deg_s <= 180.0):
            raise ValueError(f"The turn rate must be 1 to 180 degrees a second, not {rate_deg_s}.")
        self._refuse_on_ground("take off first")
        await turn_around(self._helm, rate_deg_s)

    async def hold(self) -> None:
        """Brake and hover, at any time; a flight or turn in progress ends with an error. Returns once it hovers."""
        dialect, snapshot, helm = self._monitor.dialect, self._monitor.snapshot, self._helm
        manoeuvre = helm.begin("Hold")
        if snapshot.disarmed:
            return

        def hovers() -> bool:
            speed = snapshot.speed_m_s
            return snapshot.custom_mode in dialect.hold_modes and speed is not None and speed < SETTLED_M_S

        trouble = ""
        for number, outgoing in enumerate(dialect.hold, 1):
            try:
                await helm.order(manoeuvre, outgoing, dialect.hold_modes, "hold")
                if await helm.until(manoeuvre, Deadline(self._monitor.clock, 10.0, 2.0), hovers):
                    return
                trouble = "hold was acknowledged but the vehicle does not hover"
            except CommandRefused as refusal:
                trouble = str(refusal)
            if number < len(dialect.hold):
                self._monitor.announce(f"{trouble}, ordered again ({number + 1} of {len(dialect.hold)})")
        raise VehicleError(f"{trouble}. The pilot should take over.")

    async def return_home(self) -> None:
        """Start the autopilot's own return; returns once its mode confirms."""
        self._refuse_disarmed("there is nothing to return from")
        await self._helm.select(self._helm.begin("Return"), self._monitor.dialect.return_home)

    async def land(self) -> None:
        """Start landing on the spot; returns once the mode confirms."""
        self._refuse_disarmed("there is nothing to land")
        await self._helm.select(self._helm.begin("Landing"), self._monitor.dialect.land)

    def _refuse_on_ground(self, what: str) -> None:
        self._monitor.check_connected()
        snapshot = self._monitor.snapshot
        if not (snapshot.armed and snapshot.in_air):
            raise VehicleError(f"The vehicle is not in the air: {what}.")

    def _refuse_disarmed(self, what: str) -> None:
        """Return and land are refused only when that is certain: they are the way out of trouble."""
        self._monitor.check_connected()
        if self._monitor.snapshot.disarmed:
            raise VehicleError(f"The vehicle is on the ground and not armed: {what}.")
