"""The four narrow ports through which the application reaches the world. Adapters implement them; sims are siblings.

Every adapter of a port passes the same contract tests (tests/contracts). A method that commands the vehicle returns
only when telemetry has confirmed the deed; it raises `VehicleError` (with what was tried) when it was not done in time.
"""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Protocol, runtime_checkable

from hardware.direction_finding.antenna import AntennaPattern
from hardware.readings import (
    BearingReading,
    GeoPoint,
    HeadingSample,
    PowerSample,
    PreflightCheck,
    Pulses,
    Sweep,
    Telemetry,
)


class HardwareError(RuntimeError):
    """A device did not do what it was asked; the message says what, and what to try."""


class VehicleError(HardwareError):
    """A command was refused or not confirmed by telemetry in time."""


class PilotHasControl(VehicleError):
    """The pilot took over: no command is sent until an operator releases the latch."""


class VehicleUnreachable(VehicleError):
    """No vehicle answers on the link."""


class ReceiverError(HardwareError):
    """The receiver is silent, misconfigured or gone."""


class Clock(Protocol):
    """Time as the mission sees it; a simulated clock may run faster than the wall."""

    def now(self) -> float:
        """UTC epoch seconds."""
        ...

    async def sleep(self, seconds: float) -> None:
        """Sleep so many of this clock's seconds."""
        ...


class Vehicle(Protocol):
    """A multicopter with an autopilot."""

    async def connect(self, timeout_s: float = 30.0) -> None:
        """Open the link and wait for an autopilot. Raises VehicleUnreachable."""
        ...

    async def close(self) -> None: ...

    def telemetry(self) -> Telemetry:
        """The latest snapshot; never blocks."""
        ...

    def headings(self, since_s: float) -> list[HeadingSample]:
        """Every heading heard at or after `since_s`, in time order (bounded history of a few minutes)."""
        ...

    def changes(self) -> AsyncIterator[str]:
        """Yields a line whenever who has control, the mode, or the link changes ("pilot took over: POSCTL", ...)."""
        ...

    async def preflight(self) -> list[PreflightCheck]:
        """Checks of link, GPS, heading, battery, fence and failsafe parameters."""
        ...

    async def take_off(self, altitude_relative_m: float) -> None: ...

    async def goto(self, place: GeoPoint, altitude_amsl_m: float, speed_m_s: float) -> None:
        """Fly there and return once telemetry says arrived and settled."""
        ...

    async def turn(self, rate_deg_s: float) -> None:
        """Turn once through 360 degrees on the spot; returns once telemetry has seen the whole circle."""
        ...

    async def hold(self) -> None: ...

    async def return_home(self) -> None:
        """Start the autopilot's own return; returns once its mode confirms (not once it has landed)."""
        ...

    async def land(self) -> None:
        """Start landing on the spot; returns once the mode confirms."""
        ...

    def release_pilot_latch(self) -> None:
        """The operator's explicit deed that lets commands pass again after a pilot took over."""
        ...


class Receiver(Protocol):
    """Received narrow-band power at the emitter's frequency."""

    async def open(self, frequency_hz: float) -> None:
        """Raises ReceiverError."""
        ...

    async def close(self) -> None: ...

    def samples(self) -> AsyncIterator[PowerSample]:
        """Power samples from now on. Ends when closed; raises ReceiverError when the device is gone."""
        ...


@runtime_checkable
class HearsPulses(Protocol):
    """A Receiver that can also listen to a pulsed tag: one sample a pulse."""

    def expect(self, pulses: Pulses | None) -> None:
        """Before `open`: what is listened to from then on; None: what the receiver was made for (a carrier, mostly)."""
        ...


class DirectionFinder(Protocol):
    """Sweep to bearing. Pure; called off the event loop."""

    def estimate(self, sweep: Sweep, pattern: AntennaPattern) -> BearingReading: ...
