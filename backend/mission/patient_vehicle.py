"""The vehicle that may not be there yet: connects in the background, again and again, and says so meanwhile."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Callable
from typing import Protocol, runtime_checkable

from hardware.ports import Clock, Vehicle, VehicleUnreachable
from hardware.readings import GeoPoint, HeadingSample, PreflightCheck, Telemetry

log = logging.getLogger("crossfix.mission")

ATTEMPT_S = 10.0
PAUSE_S = 2.0


@runtime_checkable
class MendsFailsafes(Protocol):
    """A vehicle whose failsafe parameters can be set from here."""

    async def mend_failsafes(self) -> list[str]:
        """Set what would not act; one line a changed parameter. Raises VehicleError."""
        ...


class PatientVehicle:
    """The Vehicle port on a link that is opened when somebody answers. `make` builds one not yet connected."""

    def __init__(self, make: Callable[[], Vehicle], clock: Clock, where: str) -> None:
        self._make = make
        self._clock = clock
        self._where = where
        self._vehicle: Vehicle | None = None
        self._there = asyncio.Event()
        self._connecting: asyncio.Task[None] | None = None
        self.detail = f"no vehicle has answered on {where} yet"

    async def connect(self, timeout_s: float = 30.0) -> None:
        """Wait at most so long for the first answer; goes on trying afterwards. Raises VehicleUnreachable."""
        if self._connecting is None:
            self._connecting = asyncio.create_task(self._keep_trying())
        try:
            async with asyncio.timeout(timeout_s):
                await self._there.wait()
        except TimeoutError:
            raise VehicleUnreachable(self.detail) from None

    async def _keep_trying(self) -> None:
        while True:
            candidate = self._make()
            try:
                await candidate.connect(ATTEMPT_S)
            except VehicleUnreachable as error:
                if str(error) != self.detail:
                    log.warning("%s", error)
                self.detail = str(error)
                await asyncio.sleep(PAUSE_S)
            except Exception as error:
                log.exception("connecting to the vehicle on %s failed inside Crossfix", self._where)
                self.detail = f"connecting to {self._where} failed inside Crossfix and is tried again: {error}"
                await candidate.close()
                await asyncio.sleep(PAUSE_S)
            except BaseException:
                await candidate.close()
                raise
            else:
                self._vehicle, self.detail = candidate, ""
                self._there.set()
                return

    async def close(self) -> None:
        if self._connecting is not None:
            self._connecting.cancel()
            await asyncio.gather(self._connecting, return_exceptions=True)
        if self._vehicle is not None:
            await self._vehicle.close()

    def _present(self) -> Vehicle:
        if self._vehicle is None:
            raise VehicleUnreachable(self.detail)
        return self._vehicle

    def telemetry(self) -> Telemetry:
        return Telemetry(False, self._clock.now()) if self._vehicle is None else self._vehicle.telemetry()

    def headings(self, since_s: float) -> list[HeadingSample]:
        return [] if self._vehicle is None else self._vehicle.headings(since_s)

    async def changes(self) -> AsyncIterator[str]:
        await self._there.wait()
        async for line in self._present().changes():
            yield line

    async def preflight(self) -> list[PreflightCheck]:
        if self._vehicle is None:
            remedy = "switch it on and check its link and address"
            return [PreflightCheck("vehicle link", False, self.detail, remedy)]
        return await self._vehicle.preflight()

    async def mend_failsafes(self) -> list[str]:
        """Only on the operator's explicit wish. Nothing for a vehicle that has no such parameters."""
        vehicle = self._present()
        return await vehicle.mend_failsafes() if isinstance(vehicle, MendsFailsafes) else []

    async def take_off(self, altitude_relative_m: float) -> None:
        await self._present().take_off(altitude_relative_m)

    async def goto(self, place: GeoPoint, altitude_amsl_m: float, speed_m_s: float) -> None:
        await self._present().goto(place, altitude_amsl_m, speed_m_s)

    async def turn(self, rate_deg_s: float) -> None:
        await self._present().turn(rate_deg_s)

    async def hold(self) -> None:
        await self._present().hold()

    async def return_home(self) -> None:
        await self._present().return_home()

    async def land(self) -> None:
        await self._present().land()

    def release_pilot_latch(self) -> None:
        if self._vehicle is not None:
            self._vehicle.release_pilot_latch()
