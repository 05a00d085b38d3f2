"""One manoeuvre at a time: begin, wait, select a mode. What each manoeuvre does is in its own module."""

from __future__ import annotations

from collections.abc import Callable

from hardware.autopilot.commander import Manoeuvre
from hardware.autopilot.dialect import ModeOrder
from hardware.autopilot.ground import distance_m
from hardware.autopilot.messages import Outgoing, set_mode
from hardware.autopilot.monitor import Monitor
from hardware.autopilot.patience import Deadline
from hardware.ports import VehicleError, VehicleUnreachable
from hardware.readings import GeoPoint

MODE_S = 0.2
"""Longer than this nothing waits for the vehicle's next word of its mode, which comes ten times a second."""
GIVE_UP_LINK_WALL_S = 15.0
"""A manoeuvre whose vehicle is silent for so many seconds of the wall ends with VehicleUnreachable (it flies on)."""


class Helm:
    """Commands of the manoeuvre that was begun last; an earlier one ends with ManoeuvreSuperseded."""

    def __init__(self, monitor: Monitor) -> None:
        self.monitor = monitor
        self.spot: tuple[GeoPoint, float] | None = None
        """The place and altitude AMSL the vehicle was last sent to."""
        self._manoeuvre: Manoeuvre | None = None

    def begin(self, name: str) -> Manoeuvre:
        """Supersede what is going on. A second hold joins the first. Raises PilotHasControl."""
        if self._manoeuvre is not None:
            if self._manoeuvre.name == name == "Hold" and self._manoeuvre.superseded_by is None:
                return self._manoeuvre
            self._manoeuvre.superseded_by = name
        self._manoeuvre = manoeuvre = Manoeuvre(name)
        self.monitor.news.tell()
        self.monitor.commander.check(manoeuvre)
        return manoeuvre

    async def order(self, manoeuvre: Manoeuvre, outgoing: Outgoing, modes: frozenset[int], what: str) -> None:
        """See Commander.order."""
        await self.monitor.commander.order(manoeuvre, outgoing, modes, what)

    async def steer(self, manoeuvre: Manoeuvre, outgoing: Outgoing, what: str) -> None:
        """An order that only moves the search on: sent right after the vehicle's next word of its mode.

        Sent later, it may undo a pilot's change of mode before the autopilot has told of it, and nobody would know.
        """
        monitor = self.monitor
        known_at_s = monitor.snapshot.mode_at_s
        told = Deadline(monitor.clock, MODE_S, MODE_S)
        await self.until(manoeuvre, told, lambda: monitor.snapshot.mode_at_s != known_at_s)
        await self.order(manoeuvre, outgoing, monitor.dialect.reposition_modes, what)

    def go_on(self, manoeuvre: Manoeuvre) -> None:
        """Raises when the manoeuvre may not go on, or its vehicle has been silent for too long."""
        self.monitor.commander.check(manoeuvre)
        silent_s = self.monitor.silence.seconds
        if not self.monitor.connected and silent_s > GIVE_UP_LINK_WALL_S:
            raise VehicleUnreachable(f"{manoeuvre.name}: nothing heard from the vehicle for {silent_s:.0f} s.")

    async def until(self, manoeuvre: Manoeuvre, deadline: Deadline, happened: Callable[[], bool]) -> bool:
        """True once it happened, False when the deadline passed."""
        while True:
            self.go_on(manoeuvre)
            if happened():
                return True
            if deadline.passed:
                return False
            await self.monitor.news.wait()

    async def select(self, manoeuvre: Manoeuvre, order: ModeOrder) -> None:
        """Select a mode and see it; what is not seen is ordered again."""
        monitor = self.monitor
        for attempt in range(1, 4):
            await self.order(manoeuvre, set_mode(order.custom), order.modes, f"mode {order.name}")
            seen = Deadline(monitor.clock, 3.0, 1.5)
            if await self.until(manoeuvre, seen, lambda: monitor.snapshot.custom_mode in order.modes):
                return
            if attempt < 3:
                monitor.announce(f"mode {order.name} acknowledged but not seen, ordered again ({attempt + 1} of 3)")
        raise VehicleError(f"The autopilot acknowledged mode {order.name} three times and never showed it.")

    def distance(self, place: GeoPoint, altitude_amsl_m: float) -> tuple[float, float]:
        """(horizontal, vertical) metres to go. Raises VehicleError while the position is not known."""
        here, amsl = self.here()
        return distance_m(here, place), abs(altitude_amsl_m - amsl)

    def here(self) -> tuple[GeoPoint, float]:
        """Where the vehicle is: place, altitude AMSL. Raises VehicleError while that is not known."""
        here, amsl = self.monitor.snapshot.position, self.monitor.snapshot.altitude_amsl_m
        if here is None or amsl is None:
            raise VehicleError("The vehicle does not know its position yet: wait for GPS.")
        return here, amsl
