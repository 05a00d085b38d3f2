"""Offline maps (PMTiles archives) and overlays: uploaded, listed, checked against an area, served to the page."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Path, Query, Request, Response

from backend.api.dependencies import PrincipalDep, ServicesDep
from backend.api.problems import PROBLEM_RESPONSES
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

ContentId = Annotated[str, Path(pattern=r"^[0-9a-f]{16}$")]
Name = Annotated[str, Query(max_length=120, description="What to call it; the file's own name when left out")]
Filename = Annotated[str, Query(max_length=255)]

RAW_BODY = {
    "requestBody": {
        "required": True,
        "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}},
    }
}
TILES: dict[int | str, dict[str, object]] = {
    status: {
        "description": text,
        "content": {"application/vnd.pmtiles": {"schema": {"type": "string", "format": "binary"}}},
    }
    for status, text in ((200, "The whole archive"), (206, "The asked range of bytes"))
}


@router.get("/maps")
async def list_maps(services: ServicesDep) -> MapList:
    """The maps on this machine."""
    raise NotImplementedError


@router.post("/maps", status_code=201, openapi_extra=RAW_BODY)
async def upload_map(
    request: Request, services: ServicesDep, principal: PrincipalDep, name: Name = "", filename: Filename = ""
) -> MapPackage:
    """Store a PMTiles v3 archive: the request's body is the file itself."""
    raise NotImplementedError


@router.post("/maps/coverage")
async def map_coverage(coverage: CoverageRequest, services: ServicesDep) -> Coverage:
    """Which part of an area the maps show, and how finely."""
    raise NotImplementedError


@router.get("/maps/{map_id}")
async def get_map(map_id: ContentId, services: ServicesDep) -> MapPackage:
    """One map."""
    raise NotImplementedError


@router.delete("/maps/{map_id}", status_code=204)
async def delete_map(map_id: ContentId, services: ServicesDep, principal: PrincipalDep) -> None:
    """Remove a map from the disk."""
    raise NotImplementedError


@router.get("/maps/{map_id}/layers")
async def map_layers(map_id: ContentId, services: ServicesDep, theme: Literal["light", "dark"] = "light") -> MapLayers:
    """How the page draws this map: a MapLibre source and its layers."""
    raise NotImplementedError


@router.get("/maps/{map_id}/tiles.pmtiles", response_class=Response, responses=TILES)
async def map_tiles(map_id: ContentId, request: Request, services: ServicesDep) -> Response:
    """The archive itself, by ranges of bytes (Range, If-Range, ETag), as the pmtiles client reads it."""
    raise NotImplementedError


@router.get("/overlays")
async def list_overlays(services: ServicesDep) -> OverlayList:
    """The overlays on this machine."""
    raise NotImplementedError


@router.post("/overlays", status_code=201, openapi_extra=RAW_BODY)
async def upload_overlay(
    request: Request, services: ServicesDep, principal: PrincipalDep, name: Name = "", filename: Filename = ""
) -> Overlay:
    """Store a GeoJSON, KML or KMZ file: the request's body is the file itself, at most 20 MB."""
    raise NotImplementedError


@router.get("/overlays/{overlay_id}")
async def get_overlay(overlay_id: ContentId, services: ServicesDep) -> OverlayCollection:
    """One overlay as a GeoJSON FeatureCollection."""
    raise NotImplementedError


@router.delete("/overlays/{overlay_id}", status_code=204)
async def delete_overlay(overlay_id: ContentId, services: ServicesDep, principal: PrincipalDep) -> None:
    """Remove an overlay."""
    raise NotImplementedError
