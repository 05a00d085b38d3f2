"""The library: labels, the truth about an emitter, deletion, and what the checked missions say together."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from dataclasses import asdict
from typing import Annotated

from fastapi import APIRouter, Query

from backend.api.dependencies import MissionId, PrincipalDep, ServicesDep
from backend.api.missions import get_mission
from backend.api.problems import PROBLEM_RESPONSES
from backend.events import Recorded
from backend.ports import JournalDamaged
from backend.search.calibration import FACTS_NEEDED, calibrate
from backend.store.reading import Wanted
from backend.wire.library import Calibration, MissionLabels, TruthTold
from backend.wire.resources import Mission

router = APIRouter(prefix="/api", tags=["library"], responses=PROBLEM_RESPONSES)

MOST_CHECKED = 300
"""The newest missions with a known truth that are looked at."""


@router.put("/missions/{mission_id}/labels")
async def label_mission(
    mission_id: MissionId, labels: MissionLabels, services: ServicesDep, principal: PrincipalDep
) -> Mission:
    """Rename a mission, tag it, write notes to it."""
    await services.missions.review.label(mission_id, labels.name, labels.tags, labels.notes, principal.name)
    return await get_mission(mission_id, services)


@router.put("/missions/{mission_id}/truth")
async def tell_truth(mission_id: MissionId, told: TruthTold, services: ServicesDep, principal: PrincipalDep) -> Mission:
    """Say where an emitter was found, or that it was not. What is said last counts; the journal keeps all of it."""
    await services.missions.review.tell_truth(
        mission_id, told.emitter_id, told.place, told.accuracy_m, told.how, principal.name
    )
    return await get_mission(mission_id, services)


@router.delete("/missions/{mission_id}", status_code=204)
async def delete_mission(mission_id: MissionId, services: ServicesDep, principal: PrincipalDep) -> None:
    """Take a mission out of the list; for thirty days it can be restored. 409 while it flies."""
    await services.missions.review.delete(mission_id, principal.name)


@router.post("/missions/{mission_id}/restore")
async def restore_mission(mission_id: MissionId, services: ServicesDep, principal: PrincipalDep) -> Mission:
    """Bring a deleted mission back into the list."""
    await services.missions.review.restore(mission_id, principal.name)
    return await get_mission(mission_id, services)


@router.get("/calibration")
async def calibration(
    services: ServicesDep,
    craft: Annotated[str, Query(max_length=40)] = "",
    antenna: Annotated[str, Query(max_length=200)] = "",
) -> Calibration:
    """How right bearings, fixes and forecasts were where the truth is known; "" for every craft or antenna."""
    checked = await services.journal.page(MOST_CHECKED, wanted=Wanted(checked=True))
    facts: dict[str, tuple[str, list[Recorded]]] = {}
    for digest in checked:
        with suppress(JournalDamaged):  # it is in the log, and says so itself when it is opened
            facts[digest.mission_id] = digest.name, await services.journal.read_kinds(digest.mission_id, FACTS_NEEDED)
    found = await asyncio.to_thread(calibrate, facts, craft, antenna)
    return Calibration.model_validate(asdict(found))
