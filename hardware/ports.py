"""The four narrow ports through which the application reaches the world. Adapters implement them; sims are siblings.

Every adapter of a port passes the same contract tests (tests/contracts). A method that commands the vehicle returns
only when telemetry has confirmed the deed; it raises `VehicleError` (with what was tried) when it was not done in time.
"""

from __future__ import annotations

from collections.abc import AsyncIterator, Sequence
from typing import TYPE_CHECKING, Protocol

from hardware.authority import Authority
from hardware.fence import MissionNets, Nets, NetsPlan
from hardware.readings import (
    Announcement,
    BearingReading,
    Channel,
    HeadingSample,
    Place,
    PowerSample,
    PreflightCheck,
    ReturnAltitude,
    Sweep,
    Telemetry,
)
from hardware.yaw_swings import Swinging
from planner.reason import ReasonedError

if TYPE_CHECKING:  # much comes with these, and a vehicle left in flight is held before that is loaded
    from hardware.direction_finding.antenna import AntennaPattern
    from hardware.reasons.union import HardwareReason


class HardwareError(ReasonedError):
    """A device did not do what it was asked; the reason says what, and what to try."""


class VehicleError(HardwareError):
    """A command was refused or not confirmed by telemetry in time."""


class NotInControl(VehicleError):
    """Somebody else took control: no command is sent until an operator takes it back."""


class PlaceRefused(VehicleError):
    """The autopilot will not fly to this place: it hovers where it is, and the same order again changes nothing."""


class VehicleUnreachable(VehicleError):
    """No vehicle answers on the link."""


class ReceiverError(HardwareError):
    """The receiver is silent, misconfigured or gone."""

    def __init__(self, reason: HardwareReason) -> None:
        super().__init__(reason)
        self._hardware_reason: HardwareReason = reason

    @property
    def reason(self) -> HardwareReason:
        """The receiver's own, or of what it listens through: a file, a driver, the payload link."""
        return self._hardware_reason


LOST_PERCENT = 1.0
"""Share of its samples; a receiver that loses more is reported."""


class Clock(Protocol):
    """Time as the mission sees it; a simulated clock may run faster than real time."""

    def now(self) -> float:
        """UTC epoch seconds."""
        ...

    async def sleep(self, seconds: float) -> None:
        """By this clock."""
        ...


class Vehicle(Protocol):
    """A multicopter with an autopilot."""

    async def connect(self, timeout_s: float = 30.0) -> None:
        """Open the link and wait for an autopilot. Raises VehicleUnreachable."""
        ...

    async def close(self) -> None:
        """Lets go of the link; the vehicle goes on with what it does."""
        ...

    def telemetry(self) -> Telemetry:
        """The latest snapshot; never blocks."""
        ...

    def headings(self, since_s: float) -> list[HeadingSample]:
        """Every heading heard at or after `since_s`, in time order (bounded history of a few minutes)."""
        ...

    def changes(self) -> AsyncIterator[Announcement]:
        """Whenever control, mode or link changes, or a command has to be repeated. From the call on."""
        ...

    async def preflight(self) -> list[PreflightCheck]:
        """Checks of link, GPS, heading, battery, fence and failsafe parameters."""
        ...

    async def take_off(self, altitude_relative_m: float) -> None:
        """Arm and climb, in the air already: climb or descend; returns once telemetry says that the altitude is
        reached."""
        ...

    async def plan_nets(self, wanted: MissionNets, own: Nets | None = None) -> NetsPlan:
        """What the autopilot's own fence would have to be for a mission; sets nothing. own: what its owner has set,
        None: what it holds now. Raises VehicleError when that would loosen the owner's, or cannot be."""
        ...

    async def set_nets(self, nets: Nets) -> None:
        """Returns once the autopilot, asked afterwards, holds exactly that. Raises VehicleError."""
        ...

    async def put_nets_back(self, before: Nets, ours: Sequence[Nets]) -> bool | None:
        """The owner's, wherever it still holds what we set or were about to. False: somebody has changed something
        since, and that stays as they have it. None: it is armed, perhaps since this began: what is not put back stays,
        for no fence changes under a pilot. Raises VehicleError."""
        ...

    async def return_altitude(self) -> ReturnAltitude:
        """Of the autopilot's own return: it is not ours to choose, and must lie below the mission's ceiling."""
        ...

    async def goto(
        self,
        place: Place,
        altitude_amsl_m: float,
        speed_m_s: float,
        heading_deg: float | None = None,
        swinging: Swinging | None = None,
    ) -> None:
        """Fly there and return once telemetry says arrived and settled. heading_deg: where the nose is wanted by then;
        an autopilot may leave it elsewhere. swinging: what the nose does on the way; nothing of it changes the mode,
        and it is over when this ends for whatever reason."""
        ...

    async def turn(self, rate_deg_s: float, by_deg: float = 360.0) -> None:
        """Turn on the spot, clockwise, negative: counterclockwise; returns once telemetry has seen all of it."""
        ...

    async def hold(self) -> None:
        """Brake and hover, at any time: a flight or turn in progress ends with an error. Returns once it hovers."""
        ...

    async def return_home(self) -> None:
        """Start the autopilot's own return; returns once its mode confirms (not once it has landed)."""
        ...

    async def land(self) -> None:
        """Start landing on the spot; returns once the mode confirms."""
        ...

    def take_control(self) -> None:
        """The operator's explicit deed that lets commands pass again after somebody else took control."""
        ...

    def restore(self, authority: Authority) -> None:
        """After a restart, before anything is commanded: go on from who flew before."""
        ...


class Receiver(Protocol):
    """Received narrow-band power of one or several emitters at once."""

    @property
    def lost_percent(self) -> float:
        """How much of what its device took in the last seconds never arrived; 0 for one that loses nothing."""
        ...

    async def open(self, channels: Sequence[Channel]) -> None:
        """Listen to these channels, all at once, until closed or opened with others.

        Raises ReceiverError, also when it cannot hear every one of them: pulses, or too many, or too far apart.
        """
        ...

    async def close(self) -> None:
        """Ends samples(). Harmless when closed already; `open` may follow."""
        ...

    def samples(self) -> AsyncIterator[PowerSample]:
        """Power samples from now on, those of each channel in time order and with that channel's exact frequency.

        Ends when closed; raises ReceiverError when the device is gone.
        """
        ...


class DirectionFinder(Protocol):
    """Sweep to bearing. Pure; called off the event loop."""

    def estimate(self, sweep: Sweep, pattern: AntennaPattern) -> BearingReading:
        """Never raises for a bad sweep: the reading is then not accepted and says why."""
        ...
