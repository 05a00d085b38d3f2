"""Before and while flying: what would it cost? And areas out of files."""

from __future__ import annotations

import asyncio

from fastapi import APIRouter

from backend.api.areas import read_area
from backend.api.dependencies import MissionId, ServicesDep
from backend.api.problems import PROBLEM_RESPONSES
from backend.spec import MissionSpec
from backend.wire.resources import AreaImport, AreaUpload, ExpectedTime, ExpectedTimeRequest, Preview

router = APIRouter(prefix="/api", tags=["planning"], responses=PROBLEM_RESPONSES)


@router.post("/missions/{mission_id}/expected-time")
async def expected_time(mission_id: MissionId, request: ExpectedTimeRequest, services: ServicesDep) -> ExpectedTime:
    """The expected time to localization when the vehicle measured at this place next."""
    raise NotImplementedError


@router.post("/preview")
async def preview_mission(spec: MissionSpec, services: ServicesDep) -> Preview:
    """Plan the first place of a mission that is not flown yet."""
    raise NotImplementedError


@router.post("/areas")
async def import_area(upload: AreaUpload) -> AreaImport:
    """Read the polygons of a GeoJSON or KML file as a mission area; 422 says what cannot be read."""
    return await asyncio.to_thread(read_area, upload)
