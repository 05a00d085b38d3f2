"""Before and while flying: what would it cost? And areas out of files."""

from __future__ import annotations

from fastapi import APIRouter

from backend.api.areas import read_area
from backend.api.dependencies import MissionId, ServicesDep
from backend.api.problems import PROBLEM_RESPONSES
from backend.api.suggestion import with_errors_estimated
from backend.spec import MissionSpec, SearchArea
from backend.wire.resources import AreaImport, AreaOutlook, AreaUpload, ExpectedTime, ExpectedTimeRequest, Preview

router = APIRouter(prefix="/api", tags=["planning"], responses=PROBLEM_RESPONSES)


@router.post("/missions/{mission_id}/expected-time")
async def expected_time(mission_id: MissionId, request: ExpectedTimeRequest, services: ServicesDep) -> ExpectedTime:
    """The expected time to localization when the vehicle measured at this place next."""
    async with services.planning:
        found = await services.missions.questions.expected_time(mission_id, request.place)
    return ExpectedTime(
        place=found.place,
        allowed=found.reason is None,
        reason=found.reason,
        expected_time_s=found.mean_s,
        std_error_s=found.std_error_s,
        time_90_s=found.p90_s,
        rollouts=found.rollouts,
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
        found = await services.missions.questions.preview(with_errors_estimated(spec))
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


@router.post("/areas")
async def import_area(upload: AreaUpload, services: ServicesDep) -> AreaImport:
    """Read the polygons of a GeoJSON or KML file as a mission area; 422 says what cannot be read."""
    return await services.workers.run(read_area, upload)
