"""Ways and barriers of a mission: uploaded, shown, taken away. Advice on where to listen keeps to them."""

from __future__ import annotations

from collections.abc import AsyncIterator
from dataclasses import dataclass
from datetime import datetime
from typing import Annotated

from fastapi import APIRouter, Depends, Request, Response

from backend.api.dependencies import MissionId, PrincipalDep, ServicesDep
from backend.api.map_files import RAW_BODY, Filename, Name, in_thread, upload
from backend.api.problems import PROBLEM_RESPONSES
from backend.api.services import Services
from backend.maps.ways_folder import WaysFolder
from backend.spec import LonLat, MissionSpec, Polygon
from backend.store.ways_files import WaysFiles
from backend.wire.ways import MissionWays
from backend.workers import Workers

router = APIRouter(prefix="/api/missions/{mission_id}/ways", tags=["planning"], responses=PROBLEM_RESPONSES)


def ways_folder(services: ServicesDep) -> WaysFolder:
    """One for each request; all of it is on disk."""
    return WaysFolder(WaysFiles.of_settings(services.settings), services.settings.disk_low_bytes)


WaysFolderDep = Annotated[WaysFolder, Depends(ways_folder)]


@dataclass(frozen=True, slots=True)
class _Upload:
    """To one mission."""

    folder: WaysFolder
    mission_id: str
    area: list[LonLat]

    async def store(
        self, body: AsyncIterator[bytes], name: str, announced_bytes: int | None, now: datetime, workers: Workers
    ) -> MissionWays:
        return await self.folder.store(self.mission_id, self.area, body, name, announced_bytes, now, workers)


@router.get("", response_class=Response, responses={200: {"model": MissionWays}})
async def get_ways(mission_id: MissionId, folder: WaysFolderDep, services: ServicesDep) -> Response:
    """What was uploaded last, cut to the search; empty when nothing was."""
    await _mission(services, mission_id)
    return Response(await in_thread("overlay", folder.json, mission_id), media_type="application/json")


@router.post("", status_code=201, openapi_extra=RAW_BODY)
async def upload_ways(
    mission_id: MissionId,
    request: Request,
    folder: WaysFolderDep,
    services: ServicesDep,
    principal: PrincipalDep,
    name: Name = "",
    filename: Filename = "",
) -> MissionWays:
    """Roads, paths and barriers as GeoJSON, KML or KMZ in the place of those before: the request's body is the file
    itself, at most 20 MB. The answer tells of them without the features."""
    corners = _corners(await _mission(services, mission_id))
    return await upload("overlay", _Upload(folder, mission_id, corners), request, services.workers, name, filename)


@router.delete("", status_code=204)
async def forget_ways(
    mission_id: MissionId, folder: WaysFolderDep, services: ServicesDep, principal: PrincipalDep
) -> None:
    """Nothing is known of the ground from then on."""
    await _mission(services, mission_id)
    await in_thread("overlay", folder.forget, mission_id)


async def _mission(services: Services, mission_id: str) -> MissionSpec:
    """Raises MissionNotFound."""
    running = services.missions.flights.running(mission_id)
    state = running.state if running else (await services.missions.records.load(mission_id))[0]
    return state.search.mission


def _corners(mission: MissionSpec) -> list[LonLat]:
    area = mission.area
    rings = area.coordinates if isinstance(area, Polygon) else [ring for part in area.coordinates for ring in part]
    return [corner for ring in rings for corner in ring]
