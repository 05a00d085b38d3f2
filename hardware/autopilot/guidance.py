"""One manoeuvre at a time: begin, wait, select a mode. What each manoeuvre does is in its own module."""

from __future__ import annotations

from collections.abc import Callable

from hardware.autopilot.commander import CommandDenied, Manoeuvre
from hardware.autopilot.dialect import ModeOrder
from hardware.autopilot.ground import distance_m
from hardware.autopilot.messages import Outgoing, set_mode
from hardware.autopilot.monitor import Monitor
from hardware.deadline import Deadline
from hardware.ports import VehicleError, VehicleUnreachable
from hardware.readings import Place
from hardware.reasons.vehicle import CommandName, ManoeuvreName, ModeNotShown, PositionLost, VehicleSilent
from hardware.reasons.vehicle_news import TriedAgain

GIVE_UP_LINK_WALL_S = 15.0
"""Wall time: a manoeuvre whose vehicle is silent for longer ends with VehicleUnreachable (the vehicle flies on)."""
ATTEMPTS = 3
DENIED_S = 1.0
"""Longer than this nothing waits for what the vehicle says of its mode after it has denied a command."""


class Guidance:
    """Commands of the manoeuvre that was begun last; an earlier one ends with ManoeuvreSuperseded."""

    def __init__(self, monitor: Monitor) -> None:
        self.monitor = monitor
        self.spot: tuple[Place, float] | None = None
        """The place and altitude AMSL the vehicle was last sent to."""
        self._manoeuvre: Manoeuvre | None = None

    def begin(self, name: ManoeuvreName) -> Manoeuvre:
        """Supersede what is going on. A second hold joins the first. Raises NotInControl."""
        if self._manoeuvre is not None:
            if self._manoeuvre.name == name == "hold" and self._manoeuvre.superseded_by is None:
                return self._manoeuvre
            self._manoeuvre.superseded_by = name
        self._manoeuvre = manoeuvre = Manoeuvre(name)
        self.monitor.wakeup.wake()
        self.monitor.commander.check(manoeuvre)
        return manoeuvre

    async def send(self, manoeuvre: Manoeuvre, outgoing: Outgoing, modes: frozenset[int], command: CommandName) -> None:
        """See Commander.send."""
        await self.monitor.commander.send(manoeuvre, outgoing, modes, command)

    async def enter_steering(self, manoeuvre: Manoeuvre) -> None:
        """The mode in which the vehicle flies to places and turns as told, selected only when it is in another."""
        steering = self.monitor.dialect.steering
        if self.monitor.snapshot.custom_mode not in steering.modes:
            await self.select(manoeuvre, steering)

    async def steer(self, manoeuvre: Manoeuvre, outgoing: Outgoing, command: CommandName) -> None:
        """A command that moves the vehicle within its mode: crossing a pilot's switch, it comes to nothing.

        Denied, it may have met a pilot's mode that is still on its way to us: then NotInControl is raised.
        """
        try:
            await self.send(manoeuvre, outgoing, self.monitor.dialect.steering.modes, command)
        except CommandDenied:
            await self.monitor.mode_heard(DENIED_S)
            self.go_on(manoeuvre)
            raise

    def go_on(self, manoeuvre: Manoeuvre) -> None:
        """Raises when the manoeuvre may not go on, or its vehicle has been silent for too long."""
        self.monitor.commander.check(manoeuvre)
        silent_s = self.monitor.silence.seconds
        if not self.monitor.connected and silent_s > GIVE_UP_LINK_WALL_S:
            raise VehicleUnreachable(VehicleSilent(manoeuvre.name, silent_s))

    async def until(self, manoeuvre: Manoeuvre, deadline: Deadline, happened: Callable[[], bool]) -> bool:
        """True once it happened, False when the deadline passed."""
        while True:
            self.go_on(manoeuvre)
            if happened():
                return True
            if deadline.passed:
                return False
            await self.monitor.wakeup.wait()

    async def select(self, manoeuvre: Manoeuvre, order: ModeOrder) -> None:
        """Select a mode and see it; one that does not show is commanded again."""
        monitor = self.monitor
        for attempt in range(1, ATTEMPTS + 1):
            await self.send(manoeuvre, set_mode(order.custom), order.modes, order.command)
            seen = Deadline(monitor.clock, 3.0, 1.5)
            if await self.until(manoeuvre, seen, lambda: monitor.snapshot.custom_mode in order.modes):
                return
            if attempt < ATTEMPTS:
                monitor.announce(TriedAgain(ModeNotShown(order.command, attempt), attempt + 1))
        raise VehicleError(ModeNotShown(order.command, ATTEMPTS))

    def distance(self, place: Place, altitude_amsl_m: float) -> tuple[float, float]:
        """(horizontal, vertical) metres to go. Raises VehicleError while the position is not known."""
        here, amsl = self.here()
        return distance_m(here, place), abs(altitude_amsl_m - amsl)

    def here(self) -> tuple[Place, float]:
        """Where the vehicle is: place, altitude AMSL. Raises VehicleError while that is not known."""
        here, amsl = self.monitor.snapshot.position, self.monitor.snapshot.altitude_amsl_m
        if here is None or amsl is None:
            raise VehicleError(PositionLost())
        return here, amsl
