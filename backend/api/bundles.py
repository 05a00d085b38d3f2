"""Bundles of other installations, opened as missions."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from backend.api.dependencies import PrincipalDep, ServicesDep
from backend.api.map_files import in_thread
from backend.api.problems import PROBLEM_RESPONSES, ApiProblem
from backend.api.ways import ways_folder
from backend.maps.brought_ways import read_brought_ways
from backend.reasons.request import BundleFileWrong, BundleUnreadable
from backend.store.brought import WAYS, BundleRefused, read_bundle
from backend.store.entries import JournalConflict
from backend.wire.library import MissionBrought

router = APIRouter(prefix="/api", tags=["library"], responses=PROBLEM_RESPONSES)

BODY = {
    "required": True,
    "content": {"application/zip": {"schema": {"type": "string", "format": "binary"}}},
}


@router.post(
    "/bundles", status_code=201, responses={200: {"model": MissionBrought}}, openapi_extra={"requestBody": BODY}
)
async def bring_in_bundle(
    request: Request, services: ServicesDep, principal: PrincipalDep, response: Response
) -> MissionBrought:
    """Bring in the bundle of another installation as a mission with the id it had there: the same events, sweeps and
    paths, so the same review, and with its ways. The same bundle again changes nothing: 200; but one that was deleted
    here is in the list again. 409: the mission is here with other facts."""
    content = await request.body()
    try:
        brought = await services.workers.run(read_bundle, content)
    except BundleRefused as refused:
        raise ApiProblem(422, refused.reason) from refused
    try:
        ways = None if brought.ways is None else await services.workers.run(read_brought_ways, brought.ways)
    except ValueError as error:
        raise ApiProblem(422, BundleFileWrong("damaged", WAYS)) from error
    size_bytes = sum(len(sweep.samples) for sweep in brought.sweeps)
    await services.stocks["recordings"].must_take(len(brought.sweeps), size_bytes)
    if ways is not None and await services.journal.mission(brought.mission_id) is None:
        # first: without their mission they are forgotten, and a mission that is here is not brought in again
        await in_thread("overlay", ways_folder(services).keep, brought.mission_id, ways)
    try:
        new = await services.journal.bring_in(brought, principal.name)
    except JournalConflict as conflict:
        raise ApiProblem(409, BundleUnreadable("differs")) from conflict
    if not new:
        response.status_code = 200
        here = await services.journal.mission(brought.mission_id)
        if here is not None and here.entry.deleted_at_us is not None:
            await services.missions.review.restore(brought.mission_id, principal.name)
    return MissionBrought(
        mission_id=brought.mission_id, already=not new, events=len(brought.rows), sweeps=len(brought.sweeps)
    )
