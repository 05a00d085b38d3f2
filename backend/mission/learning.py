"""After a flight or an antenna check: what it taught of the craft's compass and antenna is kept for the next flight."""

from __future__ import annotations

import asyncio
import logging

from backend.events import AntennaChecked
from backend.mission.equipment import MissionEquipment
from backend.mission.runner import MissionRunner
from backend.search.lessons import lesson, lesson_of_check
from backend.spec import SensorSpec
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


async def learn_from_check(
    equipment: MissionEquipment, mission_id: str, sensor: SensorSpec, checked: AntennaChecked
) -> None:
    """Of the first craft, which is the one that is checked. Never raises, as above."""
    craft = equipment.first
    try:
        found = await asyncio.to_thread(lesson_of_check, mission_id, checked, sensor)
        if found is not None:
            await equipment.lessons.keep(craft.craft_id, craft.pattern.name, found)
    except (PlannerError, OSError) as error:
        log.error("mission %s: its antenna check taught nothing of %s: %s", mission_id, craft.craft_id, error)
