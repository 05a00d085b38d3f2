"""Keeps the owner's nets: they are noted durably before a mission's go up, and put back when it is over.

What is noted and not yet put back is owed, across restarts too. It is settled when the craft stands disarmed and no
mission flies: at once, or whenever its vehicle is heard again.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field

from backend.craft.equipment import CraftEquipment
from backend.craft.nets import mission_nets
from backend.craft.safety import limits_of
from backend.events import Event, NetsNoted, NetsPutBack
from backend.mission.equipment import MissionEquipment
from backend.mission.records import Records
from backend.ports import FactRefused, JournalUnavailable
from backend.reasons import Reason
from backend.reasons.safety import PilotControls
from backend.search.task import SearchTask
from hardware.fence import Nets
from hardware.ports import HardwareError

log = logging.getLogger("crossfix.mission")

LOOK_S = 2.0
"""Wall time: how often it is asked whether what is owed can be settled."""


Record = Callable[[Event], Awaitable[None]]
"""Returns once the fact is durable."""


@dataclass(slots=True)
class Owed:
    """before: the owner's. ours: everything that this mission set or was about to set."""

    mission_id: str
    before: Nets
    ours: list[Nets]


@dataclass(slots=True)
class NetsKeeper:
    """Owes each craft's owner the fence that was there before the flight, across restarts."""

    equipment: MissionEquipment
    records: Records
    owed: dict[str, Owed] = field(default_factory=dict[str, Owed])
    """By craft."""
    _locks: dict[str, asyncio.Lock] = field(default_factory=dict[str, asyncio.Lock])

    async def recall(self) -> None:
        """After a restart: what was noted and never put back."""
        for record in await self.equipment.journal.of_nets():
            match record.event:
                case NetsNoted() as noted:
                    self._note(record.mission_id, noted)
                case NetsPutBack(craft_id=craft_id):
                    self.owed.pop(craft_id, None)
                case _:
                    pass

    def _note(self, mission_id: str, noted: NetsNoted) -> None:
        owed = self.owed.get(noted.craft_id)
        if owed is None or owed.mission_id != mission_id:
            owed = self.owed[noted.craft_id] = Owed(mission_id, noted.before, [])
        owed.ours.append(noted.after)

    def _noted(self, mission_id: str, noted: NetsNoted) -> bool:
        """The last that was: an autopilot that does not take them is given them every few seconds."""
        owed = self.owed.get(noted.craft_id)
        return owed is not None and (owed.mission_id, owed.before, owed.ours[-1]) == (
            mission_id,
            noted.before,
            noted.after,
        )

    def one(self, craft_id: str) -> asyncio.Lock:
        """Over the nets of one craft: what is put back after a landing is not overtaken by a change in flight."""
        return self._locks.setdefault(craft_id, asyncio.Lock())

    async def put_up(self, mission_id: str, craft: CraftEquipment, task: SearchTask) -> Reason | None:
        """The mission's nets into the autopilot, read back. Why not, None when they hang. Nothing is set before the
        owner's are noted durably. Under the lock of the mission."""

        async def record(event: Event) -> None:
            await self.records.append(mission_id, [event])

        async with self.one(craft.craft_id):
            try:
                if craft.craft_id in self.owed and not await self._settle(craft):
                    return PilotControls()
                await self._hang(mission_id, craft, task, None, record)
            except HardwareError as error:
                return error.reason
        return None

    async def change(self, mission_id: str, craft: CraftEquipment, task: SearchTask, record: Record) -> Reason | None:
        """In flight, for another search area; what the owner had set bounds it as before. As put_up; under `one`."""
        owed = self.owed.get(craft.craft_id)
        try:
            await self._hang(mission_id, craft, task, None if owed is None else owed.before, record)
        except HardwareError as error:
            return error.reason
        return None

    async def _hang(
        self, mission_id: str, craft: CraftEquipment, task: SearchTask, own: Nets | None, record: Record
    ) -> None:
        """own: the owner's, None where those in the autopilot are. Raises HardwareError."""
        plan = await craft.vehicle.plan_nets(mission_nets(limits_of(task)), own)
        noted = NetsNoted(craft_id=craft.craft_id, before=plan.before, after=plan.after)
        if not self._noted(mission_id, noted):
            await record(noted)
            self._note(mission_id, noted)
        await craft.vehicle.set_nets(plan.after)

    async def _settle(self, craft: CraftEquipment) -> bool:
        """Put back what is still as a mission left it; what somebody else has changed since stays as it is. False: it
        was armed meanwhile, and it stays owed."""
        owed = self.owed[craft.craft_id]
        whole = await craft.vehicle.put_nets_back(owed.before, owed.ours)
        if whole is None:
            return False
        await self.records.append(owed.mission_id, [NetsPutBack(craft_id=craft.craft_id, whole=whole)])
        del self.owed[craft.craft_id]
        return True

    async def settle(self) -> None:
        """What can be settled now. Only while no mission flies."""
        for craft_id in list(self.owed):
            craft = self.equipment.crafts.get(craft_id)
            if craft is None or not _stands(craft):
                continue
            async with self.one(craft_id):
                try:
                    await self._settle(craft)
                except (HardwareError, JournalUnavailable, FactRefused) as error:
                    log.warning("%s: its own fence is not put back yet: %s", craft_id, error)

    async def run(self, starting: asyncio.Lock, flies: Callable[[], bool]) -> None:
        """Settles whenever it can be. starting: nobody starts meanwhile. flies: a mission is in the air."""
        while True:
            await asyncio.sleep(LOOK_S)
            if self.owed and not flies():
                async with starting:
                    if not flies():
                        await self.settle()


def _stands(craft: CraftEquipment) -> bool:
    heard = craft.vehicle.telemetry()
    return heard.connected and heard.in_air is False and heard.armed is False
