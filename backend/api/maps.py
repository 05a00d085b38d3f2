"""Offline maps (PMTiles archives) and overlays: uploaded, listed, checked against an area, served to the page."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path as FilePath
from typing import Annotated

from fastapi import APIRouter, Depends, Request, Response
from fastapi.responses import FileResponse

from backend.api.dependencies import PrincipalDep, ServicesDep
from backend.api.map_files import (
    RAW_BODY,
    ContentId,
    Filename,
    Name,
    in_thread,
    upload,
)
from backend.api.problems import PROBLEM_RESPONSES
from backend.maps.coverage import TileSet, coverage
from backend.maps.drawing import Theme, map_layers
from backend.maps.folder import MapFolder
from backend.maps.make_basemap import MADE
from backend.maps.overlay_folder import OverlayFolder
from backend.wire.maps import (
    Coverage,
    CoverageRequest,
    MapLayers,
    MapList,
    MapPackage,
    Overlay,
    OverlayCollection,
    OverlayList,
)

router = APIRouter(prefix="/api", tags=["maps"], responses=PROBLEM_RESPONSES)

TILES: dict[int | str, dict[str, object]] = {
    status: {
        "description": text,
        "content": {"application/vnd.pmtiles": {"schema": {"type": "string", "format": "binary"}}},
    }
    for status, text in ((200, "The whole archive"), (206, "The asked range of bytes"))
}

BASEMAP: dict[int | str, dict[str, object]] = {
    200: {"description": "The basemap that ships, gzipped", "content": {"application/json": {"schema": {}}}}
}


@lru_cache
def _map_folder(directory: FilePath, reserve_bytes: int) -> MapFolder:
    return MapFolder(directory, reserve_bytes)


def map_folder(services: ServicesDep) -> MapFolder:
    """An upload may not take the disk that the journal keeps for itself."""
    settings = services.settings
    return _map_folder(settings.data_dir / "maps", settings.disk_low_bytes)


def overlay_folder(services: ServicesDep) -> OverlayFolder:
    """One for each request; all of it is on disk."""
    settings = services.settings
    return OverlayFolder(
        settings.data_dir / "overlays", settings.disk_low_bytes, settings.overlays_max, settings.overlays_max_bytes
    )


MapFolderDep = Annotated[MapFolder, Depends(map_folder)]
OverlayFolderDep = Annotated[OverlayFolder, Depends(overlay_folder)]


@router.get("/maps")
async def list_maps(folder: MapFolderDep) -> MapList:
    """The maps on this machine."""
    packages, unusable = await in_thread("map", folder.packages)
    return MapList(maps=packages, room_bytes=await in_thread("map", folder.room_bytes), unusable=[*unusable])


@router.post("/maps", status_code=201, openapi_extra=RAW_BODY)
async def upload_map(
    request: Request,
    folder: MapFolderDep,
    services: ServicesDep,
    principal: PrincipalDep,
    name: Name = "",
    filename: Filename = "",
) -> MapPackage:
    """Store a PMTiles v3 archive: the request's body is the file itself."""
    return await upload("map", folder, request, services.workers, name, filename)


@router.post("/maps/coverage")
async def map_coverage(request: CoverageRequest, folder: MapFolderDep) -> Coverage:
    """Which part of an area the maps show, and how finely."""

    def compare() -> Coverage:
        packages, _ = folder.packages()
        tile_sets = [
            TileSet(each.map_id, each.name, each.min_zoom, each.max_zoom, folder.archive(each.map_id).has)
            for each in packages
        ]
        return coverage(request.area, tile_sets)

    return await in_thread("map", compare)


@router.get("/maps/{map_id}")
async def get_map(map_id: ContentId, folder: MapFolderDep) -> MapPackage:
    """One map."""
    return await in_thread("map", folder.package, map_id)


@router.delete("/maps/{map_id}", status_code=204)
async def delete_map(map_id: ContentId, folder: MapFolderDep, principal: PrincipalDep) -> None:
    """Remove a map from the disk."""
    await in_thread("map", folder.delete, map_id)


@router.get("/maps/{map_id}/layers")
async def get_map_layers(map_id: ContentId, folder: MapFolderDep, theme: Theme = "light") -> MapLayers:
    """How the page draws this map: a MapLibre source and its layers."""

    def layers() -> MapLayers:
        return map_layers(folder.package(map_id), theme, folder.archive(map_id).tile_pixels())

    return await in_thread("map", layers)


@router.get("/maps/{map_id}/tiles.pmtiles", response_class=Response, responses=TILES)
async def map_tiles(map_id: ContentId, folder: MapFolderDep) -> Response:
    """The archive itself, whole or by ranges of bytes (Range, If-Range, ETag), as the pmtiles client reads it."""
    path = await in_thread("map", folder.path, map_id)
    headers = {"ETag": f'"{map_id}"', "Cache-Control": "private, max-age=0, must-revalidate"}
    return FileResponse(path, media_type="application/vnd.pmtiles", headers=headers)


@router.get("/basemap", response_class=Response, responses=BASEMAP)
async def small_basemap() -> Response:
    """Land, lakes, rivers and towns of the world for low zoom, where no map was uploaded: always sent compressed."""
    headers = {"Content-Encoding": "gzip", "Cache-Control": "private, max-age=86400"}
    return FileResponse(MADE, media_type="application/json", headers=headers)


@router.get("/overlays")
async def list_overlays(folder: OverlayFolderDep) -> OverlayList:
    """The overlays on this machine."""
    overlays, unusable = await in_thread("overlay", folder.overlays)
    return OverlayList(overlays=overlays, unusable=[*unusable])


@router.post("/overlays", status_code=201, openapi_extra=RAW_BODY)
async def upload_overlay(
    request: Request,
    folder: OverlayFolderDep,
    services: ServicesDep,
    principal: PrincipalDep,
    name: Name = "",
    filename: Filename = "",
) -> Overlay:
    """Store a GeoJSON, KML or KMZ file: the request's body is the file itself, at most 20 MB."""
    return await upload("overlay", folder, request, services.workers, name, filename)


@router.get("/overlays/{overlay_id}", response_class=Response, responses={200: {"model": OverlayCollection}})
async def get_overlay(overlay_id: ContentId, folder: OverlayFolderDep) -> Response:
    """One overlay as a GeoJSON FeatureCollection, as it was checked and stored."""
    return FileResponse(await in_thread("overlay", folder.path, overlay_id), media_type="application/json")


@router.delete("/overlays/{overlay_id}", status_code=204)
async def delete_overlay(overlay_id: ContentId, folder: OverlayFolderDep, principal: PrincipalDep) -> None:
    """Remove an overlay."""
    await in_thread("overlay", folder.delete, overlay_id)
