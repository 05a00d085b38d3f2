"""Terrain: uploaded like maps, drawn as shading and contour lines, and the ground below the next leg."""

from __future__ import annotations

import asyncio
import math
from functools import lru_cache
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Path, Query, Request, Response

from backend.api.dependencies import MissionId, PrincipalDep, ServicesDep
from backend.api.map_files import (
    RAW_BODY,
    ContentId,
    Filename,
    Name,
    in_thread,
    upload,
)
from backend.api.problems import PROBLEM_RESPONSES
from backend.maps.relief import HIGHEST_ZOOM, LOWEST_ZOOM, contours, relief_tile
from backend.maps.terrain_folder import TerrainFolder
from backend.mission.questions import Leg
from backend.terrain import Terrain
from backend.wire.terrain import Profile, TerrainFile, TerrainList
from hardware.readings import Latitude, Longitude, Place

router = APIRouter(prefix="/api", tags=["terrain"], responses=PROBLEM_RESPONSES)

TILE: dict[int | str, dict[str, object]] = {
    200: {
        "description": "A Terrarium tile",
        "content": {"image/png": {"schema": {"type": "string", "format": "binary"}}},
    },
    204: {"description": "No terrain there"},
}


def terrain_folder(services: ServicesDep) -> TerrainFolder:
    """One for each request; all of it is on disk."""
    return TerrainFolder(services.settings.data_dir / "terrain", services.settings.disk_low_bytes)


FolderDep = Annotated[TerrainFolder, Depends(terrain_folder)]
Lat = Annotated[Latitude, Query()]
Lon = Annotated[Longitude, Query()]


@router.get("/terrain")
async def list_terrain(folder: FolderDep) -> TerrainList:
    """The terrain on this machine."""
    terrains, unusable = await in_thread("terrain", folder.terrains)
    return TerrainList(
        terrains=terrains, room_bytes=await in_thread("terrain", folder.room_bytes), unusable=[*unusable]
    )


@router.post("/terrain", status_code=201, openapi_extra=RAW_BODY)
async def upload_terrain(
    request: Request,
    folder: FolderDep,
    services: ServicesDep,
    principal: PrincipalDep,
    name: Name = "",
    filename: Filename = "",
) -> TerrainFile:
    """Store a GeoTIFF of heights or a PMTiles archive of Terrarium tiles: the request's body is the file itself."""
    return await upload("terrain", folder, request, services.workers, name, filename)


@router.delete("/terrain/{terrain_id}", status_code=204)
async def delete_terrain(terrain_id: ContentId, folder: FolderDep, principal: PrincipalDep) -> None:
    """Remove terrain from the disk; missions that were flown over it keep theirs."""
    await in_thread("terrain", folder.delete, terrain_id)


@router.get("/terrain/tiles/{zoom}/{x}/{y}", response_class=Response, responses=TILE)
async def terrain_tile(
    zoom: Annotated[int, Path(ge=LOWEST_ZOOM, le=HIGHEST_ZOOM)],
    x: Annotated[int, Path(ge=0, lt=2**HIGHEST_ZOOM)],
    y: Annotated[int, Path(ge=0, lt=2**HIGHEST_ZOOM)],
    folder: FolderDep,
) -> Response:
    """All terrain as one Terrarium tile, for the map's shading."""
    tile = await in_thread("terrain", lambda: relief_tile(folder.sources(), zoom, x, y))
    if tile is None:
        return Response(status_code=204)
    return Response(tile, media_type="image/png", headers={"Cache-Control": "no-cache"})


@router.get("/terrain/contours")
async def terrain_contours(folder: FolderDep, lat: Lat, lon: Lon) -> dict[str, Any]:
    """Contour lines around a place as GeoJSON: `height_m` above mean sea level, `index` on each fifth line."""

    def lines() -> dict[str, Any]:
        terrain = folder.cut(Place(lat, lon))
        return {"type": "FeatureCollection", "features": []} if terrain is None else dict(_contours(terrain))

    return await in_thread("terrain", lines)


@lru_cache(maxsize=2)
def _contours(terrain: Terrain) -> dict[str, object]:
    return contours(terrain)


@router.get("/missions/{mission_id}/profile")
async def leg_profile(mission_id: MissionId, services: ServicesDep, lat: Lat, lon: Lon) -> Profile:
    """The ground below the way from where the vehicle is now to a place, and how high it would be flown."""
    leg = await services.missions.questions.leg(mission_id, Place(lat, lon))
    return await asyncio.to_thread(_profile, leg)


def _profile(leg: Leg) -> Profile:
    ground, flight = leg.task.ground, leg.task.mission.flight
    distance, heights = ground.profile(leg.way)
    below = ground.below(leg.way)
    return Profile(
        distance_m=[round(value, 1) for value in distance.tolist()],
        ground_m=[round(value, 1) if math.isfinite(value) else None for value in heights.tolist()],
        altitude_amsl_m=leg.altitude_amsl_m,
        home_amsl_m=ground.home_amsl_m,
        lowest_m=None if below is None else below.lowest_m,
        highest_m=None if below is None else below.highest_m,
        minimum_clearance_m=flight.minimum_clearance_m,
        maximum_above_ground_m=flight.maximum_above_ground_m,
        known=ground.terrain is not None,
        objections=[*leg.objections],
    )
