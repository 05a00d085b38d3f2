"""After a flight: what its bearings taught of the craft's compass and antenna is kept for the next one."""

from __future__ import annotations

import asyncio
import logging

from backend.mission.equipment import MissionEquipment
from backend.mission.runner import MissionRunner
from backend.search.lessons import lesson
from planner.types import PlannerError

log = logging.getLogger("crossfix.mission")


async def learn(equipment: MissionEquipment, runner: MissionRunner) -> None:
    """Never raises: without a lesson the next search only takes longer."""
    search, task, mission_id = runner.state.search, runner.task, runner.mission_id
    for craft_id, craft in runner.crafts.items():
        try:
            found = await asyncio.to_thread(lesson, mission_id, task, search, craft_id)
            if found is not None:
                await equipment.lessons.keep(craft_id, craft.equipment.pattern.name, found)
        except (PlannerError, OSError) as error:
            log.error("mission %s: its bearings taught nothing of %s: %s", mission_id, craft_id, error)
