"""What a mission left behind: events, beliefs, sweeps, track, and files to take away."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from functools import partial
from typing import Annotated, Literal

from fastapi import APIRouter, Query, Response
from fastapi.responses import StreamingResponse

from backend.api import summary
from backend.api.another_antenna import another_antenna
from backend.api.antenna_review import antenna_review
from backend.api.beliefs import FOLDED_KINDS, belief_frame
from backend.api.dependencies import MissionId, ServicesDep, SweepId
from backend.api.heavy import apart
from backend.api.missions import stored_mission
from backend.api.problems import PROBLEM_RESPONSES, ApiProblem, not_found
from backend.api.services import Services
from backend.api.what_if import SUPPOSED_KINDS, what_if
from backend.beside import beside
from backend.events import FIRST_CRAFT, Recorded
from backend.reasons.request import IqNotKept
from backend.store.brought import raw_files
from backend.store.handed_over import FactsDamaged, made_of
from backend.store.iq_folder import archive_size, archived
from backend.store.reading import damaged
from backend.store.ways_files import WaysFiles
from backend.wire import export
from backend.wire.bundle import bundle
from backend.wire.cot_export import cot_package
from backend.wire.mcap_export import mcap
from backend.wire.resources import AntennaReview, EventPage, SweepRecord, Track, WhatIf, WhatIfRequest, event_page

router = APIRouter(prefix="/api/missions/{mission_id}", tags=["review"], responses=PROBLEM_RESPONSES)

CraftId = Annotated[str, Query(pattern=r"^[A-Za-z0-9_-]{1,40}$")]
EmitterId = Annotated[str | None, Query(pattern=r"^[A-Za-z0-9_-]{1,40}$")]

MadeFormat = Literal["geojson", "kml", "csv", "json", "mcap", "cot", "bundle"]
"""Made from what the journal tells."""
ExportFormat = Literal["geojson", "kml", "csv", "json", "mcap", "cot", "bundle", "sigmf"]

EXPORTS: dict[MadeFormat, Callable[[Sequence[Recorded], export.Tracks], str | bytes]] = {
    "geojson": export.geojson,
    "kml": export.kml,
    "csv": export.bearings_csv,
    "json": export.journal_json,
    "mcap": mcap,
    "cot": cot_package,
    "bundle": bundle,
}
MEDIA_TYPES: dict[ExportFormat, str] = {
    "geojson": "application/geo+json",
    "kml": "application/vnd.google-earth.kml+xml",
    "csv": "text/csv",
    "json": "application/json",
    "mcap": "application/vnd.mcap",
    "cot": "application/zip",
    "bundle": "application/zip",
    "sigmf": "application/x-tar",
}
ENDINGS: dict[ExportFormat, str] = {"cot": "tak.zip", "bundle": "zip"}

SUPPOSED_TIMES = 5
"""A what-if takes as long as this many beliefs of the mission: one after each bearing, and a plan."""

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
            media: {"schema": {"type": "object"} if media.endswith("json") else {"type": "string"}}
            for media in MEDIA_TYPES.values()
        },
    }
}


@router.get("/events", response_model=EventPage)
async def list_events(
    mission_id: MissionId,
    services: ServicesDep,
    after: Annotated[int, Query(ge=0, le=2**31 - 1)] = 0,
    limit: Annotated[int, Query(ge=1, le=5000)] = 1000,
) -> Response:
    """Recorded events with seq > after."""
    digest = await stored_mission(services, mission_id)
    told = await services.journal.read_texts(mission_id, after, limit + 1)
    return Response(event_page(told[:limit], digest.last_seq, len(told) > limit), media_type="application/json")


@router.get("/beliefs", response_class=Response, responses=BINARY)
async def get_belief(
    mission_id: MissionId,
    services: ServicesDep,
    seq: Annotated[int | None, Query(ge=1, le=2**31 - 1)] = None,
    emitter: EmitterId = None,
    lite: bool = False,
) -> Response:
    """The belief about an emitter (None: the first) that stood at the event `seq` (None: now), as the binary frame the
    websocket sends; before the first bearing the prior. `lite`: 8-bit logarithm."""
    await stored_mission(services, mission_id)
    recorded = await services.journal.read_kinds(mission_id, FOLDED_KINDS)
    if seq is not None:
        recorded = [record for record in recorded if record.seq <= seq]
    frame = await apart(services, len(recorded), belief_frame, mission_id, recorded, lite, emitter)
    if frame is None:
        raise not_found("belief_at", str(seq)) if emitter is None else not_found("belief_about", emitter)
    return Response(frame, media_type="application/octet-stream")


@router.post("/what-if")
async def ask_what_if(mission_id: MissionId, request: WhatIfRequest, services: ServicesDep) -> WhatIf:
    """What would have been believed and chosen with another sensor model, antenna or planner. Nothing is recorded."""
    await stored_mission(services, mission_id)
    recorded = await services.journal.read_kinds(mission_id, SUPPOSED_KINDS)
    antenna = await another_antenna(services, mission_id, recorded, request)
    async with services.planning:
        found = await apart(services, SUPPOSED_TIMES * len(recorded), what_if, mission_id, recorded, request, antenna)
    if found is None:
        raise not_found("belief_after", str(request.bearings))
    return found


@router.get("/antenna")
async def get_antenna(mission_id: MissionId, services: ServicesDep, emitter: EmitterId = None) -> AntennaReview:
    """Whether the sweeps of an emitter (None: the first) fit the antenna that was measured, and which one they show."""
    await stored_mission(services, mission_id)
    recorded = await services.journal.read_kinds(mission_id, SUPPOSED_KINDS)
    found = await apart(services, len(recorded), antenna_review, recorded, emitter, services.pattern)
    if found is None:
        raise not_found("belief_about", str(emitter))
    return found


@router.get("/sweeps/{sweep_id}", response_model=SweepRecord)
async def get_sweep(mission_id: MissionId, sweep_id: SweepId, services: ServicesDep) -> Response:
    """The raw power samples of one sweep."""
    await stored_mission(services, mission_id)
    entry = await services.journal.sweep(mission_id, sweep_id)
    if entry is None:
        raise not_found("sweep", sweep_id)
    told = await beside(len(entry.samples), lambda: summary.sweep_record(entry).model_dump_json())
    return Response(told, media_type="application/json")


@router.get("/track", response_model=Track)
async def get_track(mission_id: MissionId, services: ServicesDep, craft: CraftId = FIRST_CRAFT) -> Response:
    """The flown path of a craft."""
    await stored_mission(services, mission_id)
    track = (await services.journal.tracks(mission_id)).get(craft, [])
    told = await beside(len(track), summary.track_text, mission_id, craft, track)
    return Response(told, media_type="application/json")


@router.get("/export/{format}", response_class=Response, responses=FILE)
async def export_mission(mission_id: MissionId, format: ExportFormat, services: ServicesDep) -> Response:
    """A file: geojson, kml, csv (bearings as UAV-RT writes them), json (the whole journal), mcap (Foxglove), cot (a
    data package for TAK), bundle (a zip with all of them), sigmf (the IQ of imported recordings as a SigMF archive; 404
    where none was kept)."""
    digest = await stored_mission(services, mission_id)
    headers = {"content-disposition": f'attachment; filename="crossfix-{mission_id}.{ENDINGS.get(format, format)}"'}
    if format == "sigmf":
        return await _kept_iq(services, mission_id, headers)
    facts = await services.journal.hand_over(mission_id)
    tracks = await services.journal.tracks(mission_id)
    making = EXPORTS[format]
    if format == "bundle":
        ways = await asyncio.to_thread(WaysFiles.of_settings(services.settings).content, mission_id)
        sweeps = await services.journal.sweeps(mission_id)
        making = partial(bundle, raw=await asyncio.to_thread(raw_files, mission_id, sweeps, tracks, ways))
    try:
        content = await apart(services, digest.last_seq, made_of, facts, making, tracks)
    except FactsDamaged as error:
        raise damaged(mission_id, error) from error
    return Response(content, media_type=MEDIA_TYPES[format], headers=headers)


async def _kept_iq(services: Services, mission_id: str, headers: dict[str, str]) -> StreamingResponse:
    """Read from the disk while it is sent: recordings are longer than the memory should hold."""
    kept = await asyncio.to_thread(services.iq.of, mission_id)
    if not kept:
        raise ApiProblem(404, IqNotKept())
    size = await asyncio.to_thread(archive_size, kept)
    return StreamingResponse(
        archived(kept, f"crossfix-{mission_id}"),
        media_type=MEDIA_TYPES["sigmf"],
        headers={**headers, "content-length": str(size)},
    )
