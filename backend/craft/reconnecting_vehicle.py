"""The vehicle that may not be there yet: connects in the background, again and again, and says so meanwhile."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Callable, Sequence
from typing import Protocol, runtime_checkable

from backend.reasons.checks import ConnectingBroke, NoVehicleYet
from hardware.authority import NOBODY, Authority
from hardware.fence import MissionNets, Nets, NetsPlan
from hardware.ports import Clock, Vehicle, VehicleUnreachable
from hardware.readings import Announcement, HeadingSample, Place, PreflightCheck, ReturnAltitude, Telemetry
from hardware.reasons.vehicle_news import ParameterSet
from hardware.yaw_swings import Swinging
from planner.reason import Reason

log = logging.getLogger("crossfix.mission")

ATTEMPT_S = 10.0
PAUSE_S = 2.0


@runtime_checkable
class MendsFailsafes(Protocol):
    """A vehicle whose failsafe parameters can be set from here."""

    async def mend_failsafes(self) -> list[ParameterSet]:
        """Set what would not act, and say what was changed. Raises VehicleError."""
        ...


class ReconnectingVehicle:
    """The Vehicle port on a link that is opened when somebody answers. `make` builds one not yet connected.

    Until then commands raise VehicleUnreachable, telemetry is not connected, `changes` waits, and preflight says why.
    connected: one that answers already, and from whose authority it was told to go on.
    """

    def __init__(
        self,
        make: Callable[[], Vehicle],
        clock: Clock,
        where: str,
        connected: tuple[Vehicle, Authority] | None = None,
    ) -> None:
        self._make = make
        self._clock = clock
        self._where = where
        self._vehicle: Vehicle | None = None
        self._there = asyncio.Event()
        self._connecting: asyncio.Task[None] | None = None
        self._restored: Authority | None = None
        self.reason: Reason | None = NoVehicleYet(where)
        if connected is not None:
            self._vehicle, self._restored = connected
            self.reason = None
            self._there.set()

    async def connect(self, timeout_s: float = 30.0) -> None:
        """Wait for the first answer, `timeout_s` at most; goes on trying afterwards. Raises VehicleUnreachable."""
        if self._connecting is None and self._vehicle is None:
            self._connecting = asyncio.create_task(self._keep_trying())
        try:
            async with asyncio.timeout(timeout_s):
                await self._there.wait()
        except TimeoutError:
            raise VehicleUnreachable(self._why) from None

    async def _keep_trying(self) -> None:
        while True:
            candidate = self._make()
            try:
                await candidate.connect(ATTEMPT_S)
            except VehicleUnreachable as error:
                if error.reason != self.reason:
                    log.warning("%s", error)
                self.reason = error.reason
                await asyncio.sleep(PAUSE_S)
            except Exception:
                log.exception("connecting to the vehicle on %s failed inside Crossfix", self._where)
                self.reason = ConnectingBroke(self._where)
                await candidate.close()
                await asyncio.sleep(PAUSE_S)
            except BaseException:
                await candidate.close()
                raise
            else:
                if self._restored is not None:
                    candidate.restore(self._restored)
                self._vehicle, self.reason = candidate, None
                self._there.set()
                return

    async def close(self) -> None:
        if self._connecting is not None:
            self._connecting.cancel()
            await asyncio.gather(self._connecting, return_exceptions=True)
        if self._vehicle is not None:
            await self._vehicle.close()

    @property
    def _why(self) -> Reason:
        return self.reason or NoVehicleYet(self._where)

    def _present(self) -> Vehicle:
        if self._vehicle is None:
            raise VehicleUnreachable(self._why)
        return self._vehicle

    def telemetry(self) -> Telemetry:
        if self._vehicle is None:
            return Telemetry(False, self._clock.now(), authority=self._restored or NOBODY)
        return self._vehicle.telemetry()

    def headings(self, since_s: float) -> list[HeadingSample]:
        return [] if self._vehicle is None else self._vehicle.headings(since_s)

    async def changes(self) -> AsyncIterator[Announcement]:
        await self._there.wait()
        async for announcement in self._present().changes():
            yield announcement

    async def preflight(self) -> list[PreflightCheck]:
        if self._vehicle is None:
            return [PreflightCheck("vehicle_link", False, self._why)]
        return await self._vehicle.preflight()

    async def return_altitude(self) -> ReturnAltitude:
        return await self._present().return_altitude()

    async def mend_failsafes(self) -> list[ParameterSet]:
        """Only on the operator's explicit wish. Nothing for a vehicle that has no such parameters."""
        vehicle = self._present()
        return await vehicle.mend_failsafes() if isinstance(vehicle, MendsFailsafes) else []

    async def plan_nets(self, wanted: MissionNets, own: Nets | None = None) -> NetsPlan:
        return await self._present().plan_nets(wanted, own)

    async def set_nets(self, nets: Nets) -> None:
        await self._present().set_nets(nets)

    async def put_nets_back(self, before: Nets, ours: Sequence[Nets]) -> bool | None:
        return await self._present().put_nets_back(before, ours)

    async def take_off(self, altitude_relative_m: float) -> None:
        await self._present().take_off(altitude_relative_m)

    async def goto(
        self,
        place: Place,
        altitude_amsl_m: float,
        speed_m_s: float,
        heading_deg: float | None = None,
        swinging: Swinging | None = None,
    ) -> None:
        await self._present().goto(place, altitude_amsl_m, speed_m_s, heading_deg, swinging)

    async def turn(self, rate_deg_s: float, by_deg: float = 360.0) -> None:
        await self._present().turn(rate_deg_s, by_deg)

    async def hold(self) -> None:
        await self._present().hold()

    async def return_home(self) -> None:
        await self._present().return_home()

    async def land(self) -> None:
        await self._present().land()

    def take_control(self) -> None:
        if self._vehicle is not None:
            self._vehicle.take_control()

    def restore(self, authority: Authority) -> None:
        """Kept for the vehicle that answers later. The same again changes nothing: what was heard since counts."""
        if self._vehicle is not None and authority == self._restored:
            return
        self._restored = authority
        if self._vehicle is not None:
            self._vehicle.restore(authority)
