"""What a mission left behind: events, beliefs, sweeps, track, and files to take away."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Path, Query, Response

from backend.api.dependencies import MissionId, ServicesDep, SweepId
from backend.api.problems import PROBLEM_RESPONSES
from backend.wire.resources import EventPage, SweepRecord, Track

router = APIRouter(prefix="/api/missions/{mission_id}", tags=["review"], responses=PROBLEM_RESPONSES)

ExportFormat = Literal["geojson", "kml", "csv", "json"]

BINARY: dict[int | str, dict[str, object]] = {
    200: {
        "description": "A belief frame",
        "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}},
    }
}
FILE: dict[int | str, dict[str, object]] = {
    200: {
        "description": "The file",
        "content": {
            media: {"schema": {"type": "string", "format": "binary"}}
            for media in (
                "application/geo+json",
                "application/vnd.google-earth.kml+xml",
                "text/csv",
                "application/json",
            )
        },
    }
}


@router.get("/events")
async def list_events(
    mission_id: MissionId,
    services: ServicesDep,
    after: Annotated[int, Query(ge=0, le=2**31 - 1)] = 0,
    limit: Annotated[int, Query(ge=1, le=5000)] = 1000,
) -> EventPage:
    """Recorded events with seq > after."""
    raise NotImplementedError


@router.get("/beliefs/{bearings}", response_class=Response, responses=BINARY)
async def get_belief(
    mission_id: MissionId,
    services: ServicesDep,
    bearings: Annotated[int, Path(ge=0, le=10_000)],
    lite: bool = False,
) -> Response:
    """The belief after so many bearings, as the binary frame the websocket sends; `lite`: 8-bit logarithm."""
    raise NotImplementedError


@router.get("/sweeps/{sweep_id}")
async def get_sweep(mission_id: MissionId, sweep_id: SweepId, services: ServicesDep) -> SweepRecord:
    """The raw power samples of one sweep."""
    raise NotImplementedError


@router.get("/track")
async def get_track(mission_id: MissionId, services: ServicesDep) -> Track:
    """The flown path."""
    raise NotImplementedError


@router.get("/export/{format}", response_class=Response, responses=FILE)
async def export_mission(mission_id: MissionId, format: ExportFormat, services: ServicesDep) -> Response:
    """A file: geojson, kml, csv (bearings as UAV-RT writes them), json (the whole journal)."""
    raise NotImplementedError
