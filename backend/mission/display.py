"""What is shown beside the facts: telemetry of every craft ten times a second, the status once."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass

from backend.commands import Resume
from backend.craft.equipment import CraftEquipment
from backend.craft.listening import channels_of
from backend.craft.orders import resume_refusal
from backend.craft.safety import battery_to_return_percent
from backend.craft.state import CraftState
from backend.mission.equipment import MissionEquipment
from backend.mission.flights import Flights
from backend.ports import CraftStatus, OrderStatus, Status

TELEMETRY_S = 0.1
TICKS_A_STATUS = 10


@dataclass(slots=True)
class Display:
    """Shows, and stores nothing: what must survive a restart is a fact."""

    equipment: MissionEquipment
    flights: Flights

    async def run(self) -> None:
        """Seconds of wall time, until cancelled."""
        publisher, clock = self.equipment.publisher, self.equipment.clock
        tick, orders = 0, self._orders()
        while True:
            for craft in self.equipment.crafts.values():
                publisher.telemetry(craft.craft_id, craft.vehicle.telemetry(), clock.now())
            before, orders = orders, self._orders()
            if tick % TICKS_A_STATUS == 0 or orders != before:
                publisher.status(self.status())
            tick += 1
            await asyncio.sleep(TELEMETRY_S)

    def _orders(self) -> list[OrderStatus | None]:
        return [_order(self._state(craft)) for craft in self.equipment.crafts.values()]

    def _state(self, craft: CraftEquipment) -> CraftState | None:
        """None: it is not known to fly."""
        active = self.flights.active
        if active is not None and craft.craft_id in active.crafts:
            return active.state.crafts[craft.craft_id]
        return self.flights.loose[craft.craft_id].state

    def status(self) -> Status:
        """As the page gets it; mission_id None: nothing flies."""
        active = self.flights.active
        failing = active is not None and active.outbox.failing
        return Status(
            mission_id=None if active is None else active.mission_id,
            phase=None if active is None else active.state.phase,
            crafts=tuple(self._craft(craft) for craft in self.equipment.crafts.values()),
            database="unstored" if failing else self.equipment.database(),
        )

    def _craft(self, craft: CraftEquipment) -> CraftStatus:
        active, runner, state = self.flights.active, self.flights.craft(craft.craft_id), self._state(craft)
        if active is None or runner is None:
            phase = "ground" if state is None else state.phase
            alerts = tuple(self.flights.loose[craft.craft_id].alerts.values())
            return CraftStatus(craft.craft_id, None, phase, "off", None, None, None, _order(state), alerts=alerts)
        situation = runner.watch.situation()
        heard = [runner.listening.last(channel.frequency_hz) for channel in channels_of(active.state.search.mission)]
        last = max((sample for sample in heard if sample is not None), key=lambda sample: sample.at_s, default=None)
        position = situation.telemetry.position
        needed = None
        if position is not None:
            needed = battery_to_return_percent(
                runner.limits, position, situation.endurance, situation.telemetry.altitude_relative_m
            )
        own = active.state.crafts[craft.craft_id]
        refused = None
        if own.phase in ("hold", "manual"):
            refused = resume_refusal(own, active.state.search)
            if refused is None:
                objections = runner.objections(Resume())
                refused = objections[0] if objections else None
        return CraftStatus(
            craft_id=craft.craft_id,
            mission_id=active.mission_id,
            phase=own.phase,
            resume_refused=refused,
            order=_order(state),
            receiver=runner.listening.state,
            receiver_power_db=None if last is None else last.power_db,
            receiver_age_s=runner.listening.age_s,
            settling_samples=runner.listening.settling_samples,
            receiver_lost_percent=runner.listening.lost_percent,
            battery_to_return_percent=needed,
        )


def _order(craft: CraftState | None) -> OrderStatus | None:
    ladder = None if craft is None else craft.ladder
    return None if ladder is None else OrderStatus(ladder.order, ladder.way, ladder.stage, ladder.because)
