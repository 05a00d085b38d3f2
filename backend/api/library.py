"""The library: labels, the truth about an emitter, deletion, and what the checked missions say together."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Sequence
from contextlib import suppress
from typing import Annotated

from fastapi import APIRouter, Query, Response
from pydantic import TypeAdapter

from backend.api.dependencies import MissionId, PrincipalDep, ServicesDep
from backend.api.missions import get_mission, mission_line
from backend.api.problems import PROBLEM_RESPONSES
from backend.api.services import Services
from backend.ports import JournalDamaged
from backend.search.calibration import Calibrated, calibrate
from backend.search.told import FACTS_NEEDED, Told, told
from backend.store.digest import MissionDigest
from backend.store.reading import Wanted
from backend.wire.library import Calibration, MissionLabels, TruthTold
from backend.wire.resources import Mission, MissionSummary

log = logging.getLogger("crossfix.api")

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
    """Take a mission out of the list, one whose facts are damaged, too; for thirty days it can be restored. 409 while
    it flies."""
    await services.missions.review.delete(mission_id, principal.name)


@router.post("/missions/{mission_id}/restore")
async def restore_mission(mission_id: MissionId, services: ServicesDep, principal: PrincipalDep) -> MissionSummary:
    """Bring a deleted mission back into the list; one whose facts are damaged, too."""
    await services.missions.review.restore(mission_id, principal.name)
    return await mission_line(services, mission_id)


@router.get("/calibration", response_model=Calibration)
async def calibration(
    services: ServicesDep,
    craft: Annotated[str, Query(max_length=40)] = "",
    antenna: Annotated[str, Query(max_length=200)] = "",
) -> Response:
    """How right bearings, fixes and forecasts were where the truth is known; "" for every craft or antenna."""
    checked = await services.journal.page(MOST_CHECKED, wanted=Wanted(checked=True))
    async with services.reckoning:
        known = await asyncio.to_thread(_known, services, checked)
        known |= await _reckoned(services, [digest for digest in checked if digest.mission_id not in known])
    missions = {d.mission_id: (d.name, known[d.mission_id]) for d in checked if d.mission_id in known}
    return Response(await asyncio.to_thread(_calibration, missions, craft, antenna), media_type="application/json")


def _known(services: Services, checked: Sequence[MissionDigest]) -> dict[str, Told]:
    """What is kept of them by id; what is kept of others is kept no longer."""
    services.told.forget(set(services.told.missions()) - {digest.mission_id for digest in checked})
    found = {digest.mission_id: services.told.of(digest) for digest in checked}
    return {mission_id: one for mission_id, one in found.items() if one is not None}


async def _reckoned(services: Services, checked: Sequence[MissionDigest]) -> dict[str, Told]:
    """Out of their facts, and kept; without the damaged ones, which say so in the log and when they are opened, and
    those that cannot be reckoned with: one mission takes the page from nobody."""
    found: dict[str, Told] = {}
    for digest in checked:
        with suppress(JournalDamaged):
            recorded = await services.journal.read_kinds(digest.mission_id, FACTS_NEEDED)
            try:
                found[digest.mission_id] = await asyncio.to_thread(told, recorded)
            except Exception:
                log.exception("mission %s is left out of the calibration", digest.mission_id)
                continue
            await asyncio.to_thread(services.told.keep, digest, found[digest.mission_id])
    return found


_CALIBRATED = TypeAdapter(Calibrated)


def _calibration(missions: dict[str, tuple[str, Told]], craft: str, antenna: str) -> bytes:
    """The wire's Calibration, of which Calibrated has the fields: a season has tens of thousands of bearings."""
    return _CALIBRATED.dump_json(calibrate(missions, craft, antenna))
