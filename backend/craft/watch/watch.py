"""Watches the world while a craft flies for a mission and turns what changed into the machine's inputs. Times are the
clock's."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from backend.craft import inputs
from backend.craft.equipment import CraftEquipment
from backend.craft.listening import Listening
from backend.craft.safety import Limits, Situation
from backend.craft.state import CraftState
from backend.craft.watch.authority import AuthorityWatch
from backend.craft.watch.battery import BatteryWatch
from backend.craft.watch.clock import ClockWatch
from backend.craft.watch.consumption import Consumption
from backend.craft.watch.links import LinkWatch
from backend.craft.watch.losses import LossWatch
from backend.craft.watch.said import SaidWatch
from backend.craft.watch.track import Track
from backend.craft.watch.way_down import WayDown
from hardware.reasons.vehicle_news import AutopilotSaid

TICK_S = 0.2
LONGEST_TICK_S = 1.0
"""A tick that came later than this was held up by the machine: more silence than this was not observed."""


@dataclass(slots=True)
class Watch:
    """`give` takes the inputs; `state` is asked on every tick."""

    equipment: CraftEquipment
    limits: Limits
    listening: Listening
    state: Callable[[], CraftState]
    give: Callable[[inputs.CraftInput], object]
    consumption: Consumption = field(default_factory=Consumption)
    track: Track = field(default_factory=Track)
    _links: LinkWatch = field(default_factory=LinkWatch)
    _battery: BatteryWatch = field(default_factory=BatteryWatch)
    _losses: LossWatch = field(default_factory=LossWatch)
    _clock: ClockWatch = field(default_factory=ClockWatch)
    _said: SaidWatch = field(default_factory=SaidWatch)
    _way_down: WayDown = field(default_factory=WayDown)
    _authority: AuthorityWatch = field(init=False)
    _ticked_at: float = math.inf

    def __post_init__(self) -> None:
        self._authority = AuthorityWatch(self.equipment.vehicle.telemetry().authority)

    def situation(self) -> Situation:
        """The vehicle as heard now, with what its battery drains; no tick needed."""
        telemetry, now = self.equipment.vehicle.telemetry(), self.equipment.clock.now()
        return Situation(telemetry, now, self.consumption.endurance, self._links.vehicle_since_s)

    async def run(self) -> None:
        """Until cancelled, every TICK_S of the mission's clock."""
        while True:
            self.tick()
            await self.equipment.clock.sleep(TICK_S)

    def tick(self) -> None:
        """One look at everything."""
        telemetry, now = self.equipment.vehicle.telemetry(), self.equipment.clock.now()
        self.listening.wait(min(max(now - self._ticked_at, 0.0), LONGEST_TICK_S))
        self._ticked_at = now
        self.consumption.update(telemetry)
        self.look_at_authority()
        consoles = self.equipment.publisher.watchers() if self.equipment.watch_consoles else None
        self._give_all(self._links.look(telemetry, now, self.listening.trouble, consoles))
        self._give_all(self._losses.look(self.listening.lost_percent, self.listening.trouble, now))
        self._give_all(self._clock.look(telemetry))
        self._give_all(self._battery.look(self.situation(), self.state(), self.limits))
        self._give_all(self._way_down.look(telemetry, now, self.state(), self.limits))
        self._give_all(self._said.look(now))
        self.track.update(telemetry, now)

    def hear(self, said: AutopilotSaid) -> None:
        """The autopilot said something."""
        self._give_all(self._said.hear(said, self.equipment.clock.now()))

    def look_at_authority(self) -> None:
        """Ask the vehicle who flies; also called the moment it says that something changed."""
        self._give_all(self._authority.look(self.equipment.vehicle.telemetry()))

    def _give_all(self, found: Iterable[inputs.CraftInput]) -> None:
        for given in found:
            self.give(given)
