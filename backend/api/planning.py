"""Before and while flying: what would it cost? And areas out of files."""

from __future__ import annotations

from fastapi import APIRouter, Request
from fastapi.exceptions import RequestValidationError

from backend.api.areas import AreaRefused, area_of
from backend.api.dependencies import MissionId, ServicesDep
from backend.api.problems import PROBLEM_RESPONSES
from backend.api.suggestion import with_errors_said
from backend.spec import MissionSpec, SearchArea
from backend.wire.resources import (
    AreaImport,
    AreaOutlook,
    ExpectedTime,
    ExpectedTimeRequest,
    PlacesCompared,
    Preview,
)

router = APIRouter(prefix="/api", tags=["planning"], responses=PROBLEM_RESPONSES)


@router.post("/missions/{mission_id}/expected-time")
async def expected_time(mission_id: MissionId, request: ExpectedTimeRequest, services: ServicesDep) -> ExpectedTime:
    """The expected time to localization when the vehicle measured at this place next, and beside another place."""
    async with services.planning:
        found, beside = await services.missions.questions.expected_time(mission_id, request.place, request.instead_of)
    return ExpectedTime(
        place=found.place,
        allowed=found.reason is None,
        reason=found.reason,
        expected_time_s=found.mean_s,
        std_error_s=found.std_error_s,
        time_90_s=found.p90_s,
        rollouts=found.rollouts,
        compared=None
        if beside is None
        else PlacesCompared(
            difference_s=beside.difference_s,
            std_error_s=beside.std_error_s,
            quicker=beside.quicker,
            rules=list(beside.rules),
        ),
    )


@router.post("/missions/{mission_id}/area-outlook")
async def area_outlook(mission_id: MissionId, search: SearchArea, services: ServicesDep) -> AreaOutlook:
    """What to expect if a mission in flight searched elsewhere from now on. Nothing is changed."""
    async with services.planning:
        found, vetoes = await services.missions.questions.outlook(mission_id, search)
    return AreaOutlook(
        allowed=not vetoes,
        reason=vetoes[0] if vetoes else None,
        belief=found.belief,
        plan=found.plan,
        no_plan=found.no_plan,
    )


@router.post("/preview")
async def preview_mission(spec: MissionSpec, services: ServicesDep) -> Preview:
    """Plan the first place of a mission that is not flown yet."""
    async with services.planning:
        found = await services.missions.questions.preview(with_errors_said(spec))
    return Preview(
        start=found.start,
        first_place=found.first_place,
        reason=found.reason,
        expected_time_s=found.mean_s,
        time_90_s=found.p90_s,
        times_s=found.times_s,
        candidates=found.candidates,
        rollouts=found.rollouts,
        plan_ms=found.plan_ms,
    )


AREA_BODY = {
    "required": True,
    "content": {"application/json": {"schema": {"$ref": "#/components/schemas/AreaUpload"}}},
}


@router.post("/areas", openapi_extra={"requestBody": AREA_BODY})
async def import_area(request: Request, services: ServicesDep) -> AreaImport:
    """Read the polygons of a GeoJSON or KML file as a mission area; 422 says what cannot be read."""
    try:
        return await services.workers.run(area_of, await request.body())
    except AreaRefused as refused:
        raise RequestValidationError(refused.errors) from refused
