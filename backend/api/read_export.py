"""An exported journal, read for the page: of any age in, in today's form out. Nothing is stored."""

from __future__ import annotations

import asyncio
import json
import math
from typing import Any

from fastapi import APIRouter, Request, Response
from pydantic import TypeAdapter, ValidationError
from pydantic_core import PydanticSerializationError

from backend.api.dependencies import ServicesDep
from backend.api.problems import PROBLEM_RESPONSES, ApiProblem
from backend.reasons.request import ExportUnreadable
from backend.store.exported import ExportedLater, NotExported, export_of_today
from backend.wire.resources import ExportedMission, Track, TrackFact
from planner.reason import ReasonedError

router = APIRouter(prefix="/api/recordings", tags=["review"], responses=PROBLEM_RESPONSES)

Row = tuple[str, float, float, float | None, float | None]
"""As the export writes a point of the track: UTC, latitude, longitude, altitude AMSL (m), heading."""
TRACKS = TypeAdapter(dict[str, list[Row]])

BODY = {
    "required": True,
    "content": {"application/json": {"schema": {"type": "object", "description": "mission.json as it was exported"}}},
}


SHORT_BYTES = 256 * 2**10
"""Read in a thread; the event loop waits while a longer one is parsed there."""


MOST_ITEMS = 2_000_000
"""The largest export has one in ten bytes or fewer; a list of bare numbers would fill the memory."""


class ExportRefused(ReasonedError):
    """What was sent is no exported mission that can be read."""

    def __init__(self, reason: ExportUnreadable) -> None:
        super().__init__(reason)


@router.post("/read", response_model=ExportedMission, openapi_extra={"requestBody": BODY})
async def read_exported_mission(request: Request, services: ServicesDep) -> Response:
    """The events and the flown paths of an exported mission, whichever Crossfix exported it."""
    text = await request.body()
    try:
        if len(text) <= SHORT_BYTES:
            answer = await asyncio.to_thread(read_export, text)
        else:
            answer = await services.workers.run(read_export, text)
    except ExportRefused as refused:
        raise ApiProblem(422, refused.reason) from refused
    return Response(answer, media_type="application/json")


def read_export(text: bytes) -> str:
    """The answer's JSON. Raises ExportRefused."""
    if text.count(b",") > MOST_ITEMS:
        raise ExportRefused(ExportUnreadable("not_exported"))
    try:
        parsed = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ExportRefused(ExportUnreadable("not_json")) from error
    try:
        exported = export_of_today(parsed)
        del parsed  # of a large mission it is ten times its text
        mission = ExportedMission(
            mission_id=exported["mission_id"],
            events=exported["events"],
            tracks=[
                _track(exported["mission_id"], *path) for path in TRACKS.validate_python(exported["tracks"]).items()
            ],
        )
        return mission.model_dump_json()
    except ExportedLater as error:
        raise ExportRefused(ExportUnreadable("later")) from error
    except (NotExported, ValidationError, PydanticSerializationError, RecursionError) as error:
        raise ExportRefused(ExportUnreadable("not_exported")) from error  # half a surrogate pair is no text to write


def _track(mission_id: Any, craft_id: str, rows: list[Row]) -> Track:
    points = [
        TrackFact.model_validate(
            {
                "at_utc": at_utc,
                "lat": lat,
                "lon": lon,
                "altitude_amsl_m": _known(altitude_amsl_m),
                "altitude_relative_m": None,
                "heading_deg": _known(heading_deg),
                "battery_percent": None,
                "mode": None,
            }
        )
        for at_utc, lat, lon, altitude_amsl_m, heading_deg in rows
        if math.isfinite(lat) and math.isfinite(lon)
    ]
    return Track(mission_id=mission_id, craft_id=craft_id, points=points)


def _known(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
