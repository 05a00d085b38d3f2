"""After a flight or an antenna check, or when an emitter was found: what that taught of the craft's compass and antenna
is kept for the next flight."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Sequence

from backend.events import AntennaChecked, MissionStarted, Recorded
from backend.mission.equipment import MissionEquipment
from backend.mission.runner import MissionRunner
from backend.search.errors import MissionInputError
from backend.search.lessons import lesson, lesson_of_check
from backend.search.state import SearchState
from backend.search.task import search_task
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


async def learn_from_truth(
    equipment: MissionEquipment, mission_id: str, search: SearchState, recorded: Sequence[Recorded]
) -> None:
    """Where an emitter was is known now, or no longer: what the flight taught is judged again by the facts so far.
    recorded: the starts of its craft.

    Only what is still kept is: a flight from before a calibration, forgotten since, stays forgotten. Never raises.
    """
    if search.stage != "ended" or search.home is None:
        return
    for started in (r.event for r in recorded if isinstance(r.event, MissionStarted) and r.event.antenna is not None):
        craft_id, antenna = started.craft_id, "" if started.antenna is None else started.antenna.name
        try:
            kept = await equipment.lessons.of(craft_id, antenna)
            if all(one.mission_id != mission_id for one in kept):
                continue
            task = await asyncio.to_thread(search_task, search.mission, search.home, search.home_amsl_m)
            found = await asyncio.to_thread(lesson, mission_id, task, search, craft_id)
            if found is not None:
                await equipment.lessons.keep(craft_id, antenna, found)
        except (PlannerError, MissionInputError, OSError) as error:
            log.error("mission %s: where its emitter was taught nothing of %s: %s", mission_id, craft_id, error)


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
