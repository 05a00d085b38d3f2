"""A craft that flies for no mission: shown, and held, brought home or landed when a person says so.

It answers as one whose search is over (machine.py): the same ladder of an order, the same silence while a pilot has it.
Nothing is sent by itself. What happens is logged and shown, alerts too: the autopilot's words, a lost GPS, a battery
that runs low. No mission's journal tells of it.
"""

from __future__ import annotations

import asyncio
import logging
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from backend import commands
from backend.craft import inputs
from backend.craft.effects import LeaveSearch
from backend.craft.equipment import CraftEquipment
from backend.craft.hands import Hands
from backend.craft.machine import transition
from backend.craft.safety import resume_vetoes
from backend.craft.state import CraftState, pilot_has
from backend.craft.watch.authority import AuthorityWatch
from backend.craft.watch.charge import ChargeWatch
from backend.craft.watch.links import LinkWatch
from backend.craft.watch.said import SaidWatch
from backend.events import AlertCleared, AlertRaised, Event
from backend.ports import CraftAlert
from backend.reasons import Reason
from backend.reasons.access import CommandIdReused
from backend.reasons.refusals import OnTheGround
from backend.search.effects import Record, Refuse
from backend.search.state import SearchState
from hardware.authority import NOBODY
from hardware.readings import Telemetry
from hardware.reasons.vehicle_news import AutopilotSaid

log = logging.getLogger("crossfix.craft")

TICK_S = 0.2
LANDED_FOR_S = 1.0
HEARD_AGAIN_WALL_S = 1.0
OVER = SearchState(started_at_s=0.0, outcome="aborted")
"""The search of a craft that searches nothing."""

LooseCommand = commands.Hold | commands.Return | commands.Land | commands.Resume


@dataclass(slots=True)
class LooseCraft:
    """busy: it flies for a mission, which looks after it then. state: None while it is not known to fly without one."""

    equipment: CraftEquipment
    busy: Callable[[], bool]
    state: CraftState | None = None
    _hands: Hands = field(init=False)
    _authority: AuthorityWatch = field(init=False)
    alerts: dict[str, CraftAlert] = field(default_factory=dict[str, CraftAlert])
    """Those that are open, by their ids."""
    _links: LinkWatch = field(default_factory=LinkWatch)
    _said: SaidWatch = field(default_factory=SaidWatch)
    _charge: ChargeWatch = field(default_factory=ChargeWatch)
    _answered: dict[str, tuple[LooseCommand, Reason | None]] = field(
        default_factory=dict[str, "tuple[LooseCommand, Reason | None]"]
    )
    _grounded_at_s: float = math.inf

    def __post_init__(self) -> None:
        equipment = self.equipment
        self._authority = AuthorityWatch(NOBODY)
        self._hands = Hands(equipment.vehicle, equipment.clock, self._known, self._give, self._look)

    async def run(self) -> None:
        """Until cancelled."""
        hearing = asyncio.create_task(self._hear())
        try:
            while True:
                try:
                    self.tick()
                except Exception:
                    log.exception("%s: watching it failed", self.equipment.craft_id)
                await self.equipment.clock.sleep(TICK_S)
        finally:
            hearing.cancel()
            await asyncio.gather(hearing, return_exceptions=True)
            await self._hands.close()

    async def _hear(self) -> None:
        """The autopilot's words, those of a vehicle that was connected again too."""
        while True:
            try:
                async for announcement in self.equipment.vehicle.changes():
                    if self.state is not None and isinstance(announcement.reason, AutopilotSaid):
                        self._give_all(self._said.hear(announcement.reason, self.equipment.clock.now()))
            except Exception:
                log.exception("%s: hearing it failed", self.equipment.craft_id)
            await asyncio.sleep(HEARD_AGAIN_WALL_S)

    def tick(self) -> None:
        """One look at the vehicle."""
        telemetry = self.equipment.vehicle.telemetry()
        if self.busy():
            self._forget()
        elif self.state is None:
            self._authority.known = telemetry.authority
            if telemetry.in_air is True and telemetry.connected:
                self._find(telemetry)
        else:
            self._look()
            ordered, now = self._state_now(), self.equipment.clock.now()
            if ordered is not None and ordered.ladder is not None:
                self._give_all(self._links.look(telemetry, now, None, None))
            else:  # of a link that comes back nothing would be ordered again
                self._give_all(self._links.look_at_gps(telemetry, now))
            self._give_all(self._charge.look(telemetry, now))
            self._give_all(self._said.look(now))
            self._landed(telemetry)

    def _state_now(self) -> CraftState | None:
        """A look may have changed it."""
        return self.state

    def order(self, command_id: str, by: str, command: LooseCommand) -> Reason | None:
        """Why it is refused, None when it is on its way. The same id gets the same answer; with another order it is
        refused."""
        if command_id not in self._answered:
            self._answered[command_id] = (command, self._order(by, command))
        first, answer = self._answered[command_id]
        return answer if first == command else CommandIdReused(first.kind)

    def answered(self, command_id: str) -> bool:
        """It gets its answer again."""
        return command_id in self._answered

    def leave(self) -> None:
        """The server is about to end: a return by our own way points is held."""
        self._give(inputs.Leaving(self.equipment.vehicle.telemetry().authority.homeward))

    def _order(self, by: str, command: LooseCommand) -> Reason | None:
        telemetry = self.equipment.vehicle.telemetry()
        if self.state is None:
            if self._hands.down:
                return OnTheGround()
            self._find(telemetry)
        self._look()
        objections = resume_vetoes(telemetry) if isinstance(command, commands.Resume) else ()
        refused = self._give(inputs.CraftOrdered(by, command, objections))
        log.warning("%s, in no mission: %s by %s%s", self.equipment.craft_id, command.kind, by,
                    "" if refused is None else f" refused: {refused}")  # fmt: skip
        return refused

    def _find(self, telemetry: Telemetry) -> None:
        authority = telemetry.authority
        self._authority.known = authority
        self._links, self._said, self._charge = LinkWatch(), SaidWatch(), ChargeWatch()
        self._grounded_at_s = math.inf
        phase = "manual" if pilot_has(authority) else "hold"
        self.state = CraftState(self.equipment.craft_id, phase, engaged=True, took_off=True, authority=authority)
        log.warning("%s is in the air and flies for no mission (%s)", self.equipment.craft_id, telemetry.mode)

    def _forget(self) -> None:
        if self.state is not None:
            self.state = None
            self.alerts.clear()
            for name in ("landing", "order"):
                self._hands.stop_timer(name)
            self._hands.cancel_work()

    def _landed(self, telemetry: Telemetry) -> None:
        now = self.equipment.clock.now()
        if telemetry.in_air is not False or not telemetry.connected:
            self._grounded_at_s = math.inf
        elif now - self._grounded_at_s >= LANDED_FOR_S:
            self._give(inputs.Landed())
        else:
            self._grounded_at_s = min(self._grounded_at_s, now)

    def _look(self) -> None:
        for given in self._authority.look(self.equipment.vehicle.telemetry()):
            self._give(given)

    def _known(self) -> CraftState:
        return self.state or CraftState(self.equipment.craft_id)

    def _give_all(self, found: Iterable[inputs.CraftInput]) -> None:
        for given in found:
            self._give(given)

    def _give(self, given: inputs.CraftInput) -> Reason | None:
        """Why it was refused, None when it was taken."""
        if self.state is None:
            return None
        self.state, asked = transition(self.state, OVER, given, self.equipment.clock.now())
        refused = None
        for effect in asked:
            match effect:
                case Record(event=event):
                    log.info("%s: %s", self.equipment.craft_id, event)
                    self._show(event)
                case Refuse(reason=reason):
                    refused = reason
                case LeaveSearch():
                    self._forget()
                case _:
                    self._hands.carry_out(effect)  # type: ignore[arg-type]
        return refused

    def _show(self, event: Event) -> None:
        match event:
            case AlertRaised(alert_id=alert_id, topic=topic, level=level, reason=reason):
                raised_s = self.equipment.clock.now()
                self.alerts[alert_id] = CraftAlert(alert_id, topic, level, reason, raised_s)
            case AlertCleared(alert_id=alert_id):
                self.alerts.pop(alert_id, None)
            case _:
                pass
