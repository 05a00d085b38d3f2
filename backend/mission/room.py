"""The mission room: its parts made and started together, stopped in the opposite order."""

from __future__ import annotations

import asyncio
import logging
from dataclasses import dataclass, field

from backend.mission.display import Display
from backend.mission.drafts import Drafts
from backend.mission.equipment import MissionEquipment
from backend.mission.flights import Flights
from backend.mission.nets import NetsKeeper
from backend.mission.questions import Questions
from backend.mission.records import Records
from backend.mission.reports import Reports
from backend.mission.review import Review
from hardware.ports import VehicleUnreachable

log = logging.getLogger("crossfix.mission")

CONNECT_AT_START_S = 3.0


@dataclass(slots=True)
class MissionRoom:
    """Lives on one event loop from `start_up` to `shut_down`."""

    equipment: MissionEquipment
    records: Records
    flights: Flights
    drafts: Drafts
    questions: Questions
    reports: Reports
    review: Review
    display: Display
    _showing: asyncio.Task[None] | None = field(default=None)

    async def start_up(self) -> None:
        """Connect the craft (goes on in the background) and bring an unfinished mission back into hold."""
        for craft in self.equipment.crafts.values():
            try:
                await craft.vehicle.connect(CONNECT_AT_START_S)
            except VehicleUnreachable as error:
                log.warning("%s", error)
        await self.flights.recover()
        self._showing = asyncio.create_task(self.display.run())

    async def shut_down(self) -> None:
        """Stops watching; each vehicle goes on with what it was ordered, and its own failsafe acts."""
        if self._showing is not None:
            self._showing.cancel()
            await asyncio.gather(self._showing, return_exceptions=True)
        await self.flights.close()
        for craft in self.equipment.crafts.values():
            await craft.vehicle.close()


def mission_room(equipment: MissionEquipment) -> MissionRoom:
    """Nothing runs before `start_up`."""
    records = Records(equipment.journal, equipment.publisher, equipment.clock)
    flights = Flights(equipment, records, NetsKeeper(equipment, records))
    return MissionRoom(
        equipment=equipment,
        records=records,
        flights=flights,
        drafts=Drafts(equipment, records, flights),
        questions=Questions(equipment, records, flights),
        reports=Reports(records, flights, equipment.clock),
        review=Review(records, flights),
        display=Display(equipment, flights),
    )
