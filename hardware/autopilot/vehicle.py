"""The Vehicle port over MAVSDK. Acknowledgement is not success: every deed is confirmed by telemetry."""

from __future__ import annotations

import math
from collections.abc import AsyncIterator, Sequence
from typing import Literal

from hardware.authority import Authority, OperatorTookControl
from hardware.autopilot.dialect import FailsafeRule
from hardware.autopilot.flight import Flight, fly_to
from hardware.autopilot.guidance import Guidance
from hardware.autopilot.hold import hold
from hardware.autopilot.monitor import Monitor
from hardware.autopilot.nets import put_nets_back, read_nets, set_nets
from hardware.autopilot.opening import Connection
from hardware.autopilot.preflight import Readiness, failsafe_check, telemetry_checks
from hardware.autopilot.take_off import MOST_SAID, take_off
from hardware.autopilot.turn import turn_around
from hardware.fence import MissionNets, Nets, NetsPlan
from hardware.ports import Clock, VehicleError
from hardware.readings import Announcement, HeadingSample, Place, PreflightCheck, ReturnAltitude, Telemetry
from hardware.reasons.vehicle import (
    NotInTheAir,
    ParameterNotSet,
    StandsDisarmed,
)
from hardware.reasons.vehicle_news import OperatorInControl, ParameterSet
from hardware.yaw_swings import Swinging

SAID_LATELY_S = 40.0
"""ArduPilot says every 30 s why it does not arm."""


class MavsdkVehicle:
    """A PX4 or ArduCopter multicopter. `connect` before anything else; after `close` make a new one.

    A cancelled manoeuvre sends nothing more; the vehicle ends what it was commanded last. `hold` stops it. opened: see
    MavlinkLink.
    """

    def __init__(
        self, url: str, clock: Clock, minimum_battery_percent: float = 30.0, opened: Connection | None = None
    ) -> None:
        self._monitor = Monitor(url, clock, opened)
        self._guidance = Guidance(self._monitor)
        self._minimum_battery_percent = minimum_battery_percent

    async def connect(self, timeout_s: float = 30.0) -> None:
        """Open the link and wait for an autopilot (wall seconds). Raises VehicleUnreachable."""
        await self._monitor.connect(timeout_s)

    async def close(self) -> None:
        """Idempotent. The vehicle goes on with what it was commanded."""
        await self._monitor.close()

    # -- what is heard ---------------------------------------------------------------------------------------------

    def telemetry(self) -> Telemetry:
        """The latest snapshot; never blocks."""
        return self._monitor.telemetry()

    def headings(self, since_s: float) -> list[HeadingSample]:
        """Every heading heard at or after `since_s`, in time order (the last five minutes)."""
        return self._monitor.snapshot.headings(since_s)

    def changes(self) -> AsyncIterator[Announcement]:
        """Whenever control, mode or link changes, or a command has to be repeated. From the call on."""
        return self._monitor.changes()

    async def preflight(self) -> list[PreflightCheck]:
        """Checks of link, GPS, heading, battery, home, readiness, Remote ID and failsafe parameters, with remedies."""
        dialect, monitor = self._monitor.dialect, self._monitor
        heard, snapshot = self.telemetry(), monitor.snapshot
        prearm_ok = dialect.prearm_ok(snapshot.prearm_present, snapshot.prearm_healthy)
        in_our_mode = dialect.prearm_has_present_bit or snapshot.custom_mode in dialect.take_off_modes
        said = " / ".join(monitor.said_since(heard.at_s - SAID_LATELY_S)[-MOST_SAID:])
        readiness = Readiness(prearm_ok, snapshot.prearm_healthy is not None, in_our_mode, said)
        checks = telemetry_checks(heard, readiness, monitor.remote_id, self._minimum_battery_percent)
        found = [(rule, *await self._failsafe(rule)) for rule in dialect.failsafes]
        charge_known = heard.battery_percent is not None
        for rule, name, value in found:
            if rule.watch == "station_time" and value is not None and value > 0.0:
                monitor.patience_s = value
            thresholds = {one: await monitor.link.parameter(one) for one in rule.thresholds or ()}
            checks.append(failsafe_check(rule, name, value, thresholds, charge_known))
        return checks

    async def return_altitude(self) -> ReturnAltitude:
        """Of the autopilot's own return."""
        dialect = self._monitor.dialect
        parameter, altitude_m = await self._first_read(dialect.return_altitudes)
        if not dialect.return_climbs:
            return ReturnAltitude(parameter, altitude_m)
        return ReturnAltitude(parameter, altitude_m, *await self._first_read(dialect.return_climbs))

    async def _first_read(self, names: Sequence[tuple[str, float]]) -> tuple[str, float | None]:
        """names: of one length, with the unit of each in metres. (The one this version has, m); None: none was read."""
        link = self._monitor.link
        for name, metres in sorted(names, key=lambda one: not link.has_answered(one[0])):
            value = await link.parameter(name)
            if value is not None:
                return name, value * metres
        return names[0][0], None

    async def _failsafe(self, rule: FailsafeRule) -> tuple[str, float | None]:
        """(the name this version has, its value or None)."""
        link = self._monitor.link
        value = await link.parameter(rule.parameter)
        if value is None and rule.formerly is not None:
            return rule.formerly, await link.parameter(rule.formerly)
        return rule.parameter, value

    async def mend_failsafes(self) -> list[ParameterSet]:
        """Set every failsafe parameter that would not act to its remedy. Only on the operator's explicit wish."""
        done: list[ParameterSet] = []
        for rule in self._monitor.dialect.failsafes:
            name, value = await self._failsafe(rule)
            if value is None or rule.holds(value):
                continue
            wanted = rule.wanted(value)
            if not await self._monitor.link.set_parameter(name, wanted):
                raise VehicleError(ParameterNotSet(name, wanted))
            done.append(ParameterSet(name, value, wanted))
            self._monitor.announce(done[-1])
        return done

    async def nets(self) -> Nets:
        """What the autopilot's own fence is now. Raises VehicleError when it cannot be read."""
        return await read_nets(self._monitor)

    async def plan_nets(self, wanted: MissionNets, own: Nets | None = None) -> NetsPlan:
        """What `set_nets` would have to set for a mission; sets nothing. own: the owner's, None: those it holds now.
        Raises VehicleError when that would loosen what the owner has set, or cannot be."""
        from hardware.autopilot.fence_plan import plan_nets  # shapely comes with it: a hold does not wait for that

        present = await read_nets(self._monitor) if own is None else own
        return plan_nets(self._monitor.dialect, present, wanted)

    async def set_nets(self, nets: Nets) -> None:
        """Returns once the autopilot, asked afterwards, holds exactly that. Raises VehicleError; what it holds then is
        not known."""
        await set_nets(self._monitor, nets)

    async def put_nets_back(self, before: Nets, ours: Sequence[Nets]) -> bool | None:
        """Of what is still as we left it, or were about to. False: somebody has changed something since, and that stays
        as they have it. None: it is armed, perhaps since this began, and the rest stays. Raises VehicleError."""
        return await put_nets_back(self._monitor, before, ours)

    def take_control(self) -> None:
        """The operator's explicit deed that lets commands pass again after somebody else took control."""
        authority = self._monitor.control.authority
        if authority.taken_by is not None:
            if authority.who != "failsafe":  # which gives nothing back by a switch: one that moves now is a pilot's
                self._monitor.mode_switch.taken_back(self._monitor.clock.now())
            self._monitor.control.see(OperatorTookControl())
            self._monitor.announce(OperatorInControl())

    def restore(self, authority: Authority) -> None:
        """After a restart, before anything is commanded: go on from who flew before."""
        self._monitor.restore(authority)

    # -- manoeuvres ------------------------------------------------------------------------------------------------

    async def take_off(self, altitude_relative_m: float) -> None:
        """Arm, take off and climb; in the air already: climb or descend there. Confirmed by altitude."""
        if not (math.isfinite(altitude_relative_m) and altitude_relative_m > 0):
            raise ValueError(f"The take-off altitude must be metres above home, above zero, not {altitude_relative_m}.")
        snapshot = self._monitor.snapshot
        if snapshot.armed and snapshot.in_air:
            place, amsl = self._guidance.here()
            await self.goto(place, amsl + altitude_relative_m - (snapshot.altitude_relative_m or 0.0), 5.0)
        else:
            await take_off(self._guidance, altitude_relative_m)

    async def goto(
        self,
        place: Place,
        altitude_amsl_m: float,
        speed_m_s: float,
        heading_deg: float | None = None,
        swinging: Swinging | None = None,
    ) -> None:
        """Fly there and return once telemetry says arrived and settled. heading_deg: of the nose by then, if the
        autopilot can; None: as it likes. swinging: what the nose does until it is near."""
        numbers = (place.lat, place.lon, altitude_amsl_m, speed_m_s, heading_deg or 0.0)
        off_earth = abs(place.lat) > 90 or abs(place.lon) > 180
        if not all(map(math.isfinite, numbers)) or speed_m_s <= 0 or off_earth:
            raise ValueError(f"No place to fly to: {place}, {altitude_amsl_m} m AMSL at {speed_m_s} m/s.")
        self._refuse_on_ground()
        await fly_to(self._guidance, Flight(place, altitude_amsl_m, speed_m_s, heading_deg, swinging))

    async def turn(self, rate_deg_s: float, by_deg: float = 360.0) -> None:
        """Turn on the spot, clockwise, negative: counterclockwise; returns once telemetry has seen all of it."""
        if not (math.isfinite(rate_deg_s) and 1.0 <= rate_deg_s <= 180.0):
            raise ValueError(f"The turn rate must be 1 to 180 degrees a second, not {rate_deg_s}.")
        if not 0.0 < abs(by_deg) <= 360.0:
            raise ValueError(f"A turn must be by more than 0 and at most 360 degrees either way, not by {by_deg}.")
        self._refuse_on_ground()
        await turn_around(self._guidance, rate_deg_s, by_deg)

    async def hold(self) -> None:
        """Brake and hover, at any time; a flight or turn in progress ends with an error. Returns once it is at rest."""
        self._monitor.check_connected()
        await hold(self._guidance)

    async def return_home(self) -> None:
        """Start the autopilot's own return; returns once its mode confirms."""
        self._refuse_disarmed("return")
        await self._guidance.select(self._guidance.begin("return"), self._monitor.dialect.return_home)

    async def land(self) -> None:
        """Start landing on the spot; returns once the mode confirms."""
        self._refuse_disarmed("landing")
        await self._guidance.select(self._guidance.begin("landing"), self._monitor.dialect.land)

    def _refuse_on_ground(self) -> None:
        self._monitor.check_connected()
        snapshot = self._monitor.snapshot
        if not (snapshot.armed and snapshot.in_air):
            raise VehicleError(NotInTheAir())

    def _refuse_disarmed(self, manoeuvre: Literal["return", "landing"]) -> None:
        """Return and land are refused only when that is certain: they are the way out of trouble."""
        self._monitor.check_connected()
        if self._monitor.snapshot.disarmed:
            raise VehicleError(StandsDisarmed(manoeuvre))
