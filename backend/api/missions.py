"""Missions: drafted, edited, checked, commanded."""

from __future__ import annotations

import asyncio
from datetime import UTC, datetime
from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Query, Request

from backend.api import summary
from backend.api.dependencies import MetersDep, MissionId, PrincipalDep, ServicesDep
from backend.api.ordering import ordered, permit
from backend.api.problems import PROBLEM_RESPONSES
from backend.api.services import Services
from backend.api.suggestion import with_errors_said
from backend.beside import beside
from backend.commands import CommandReply, CommandRequest
from backend.events import CheckFact
from backend.logs import about
from backend.search.errors import MissionNotFound
from backend.spec import MissionSpec
from backend.store.digest import MissionDigest, to_us
from backend.store.reading import PlaceInList, Wanted
from backend.wire.library import ResultName
from backend.wire.resources import AntennaCheckRequest, Mission, MissionList, MissionSummary, PreflightReply

_NUMBER = r"-?[0-9]{1,3}(\.[0-9]{1,12})?"
BOX = rf"^{_NUMBER},{_NUMBER},{_NUMBER},{_NUMBER}$"
Said = Annotated[str, Query(max_length=200, pattern=r"^[^\x00]*$")]

router = APIRouter(prefix="/api/missions", tags=["missions"], responses=PROBLEM_RESPONSES)


async def stored_mission(services: Services, mission_id: str) -> MissionDigest:
    """Raises MissionNotFound."""
    digest = await services.journal.mission(mission_id)
    if digest is None:
        raise MissionNotFound(mission_id)
    return digest


async def _mission(services: Services, mission_id: str) -> Mission:
    digest = await stored_mission(services, mission_id)
    kept = await asyncio.to_thread(services.iq.sizes, [mission_id])
    recorded = await services.journal.read_kinds(mission_id, summary.DETAIL_KINDS)
    return await beside(len(recorded), summary.mission, digest, kept.get(mission_id, 0), recorded)


async def mission_line(services: Services, mission_id: str) -> MissionSummary:
    """As the list has it, without a look at its facts. Raises MissionNotFound."""
    digest = await stored_mission(services, mission_id)
    kept = await asyncio.to_thread(services.iq.sizes, [mission_id])
    return summary.mission_summary(digest, kept.get(mission_id, 0))


@router.get("")
async def list_missions(
    services: ServicesDep,
    limit: Annotated[int, Query(ge=1, le=500)] = 100,
    after: Annotated[str | None, Query(pattern=r"^[0-9]{1,18}\.[A-Za-z0-9_-]{1,64}$")] = None,
    named: Said = "",
    emitter: Said = "",
    vehicle: Said = "",
    outcome: ResultName = "",
    box: Annotated[str | None, Query(pattern=BOX, max_length=120)] = None,
    since: Annotated[datetime | None, Query()] = None,
    until: Annotated[datetime | None, Query()] = None,
    deleted: bool = False,
) -> MissionList:
    """Missions, newest first, a page at a time. after: `next` of the page before. named: a part of name, tags or notes.
    emitter: of an emitter's name, id or frequency in MHz. box: west,south,east,north that the area meets, degrees.
    since, until: drafted, UTC. deleted: those that wait to be gone."""
    wanted = Wanted(
        named=named,
        emitter=emitter,
        vehicle=vehicle,
        outcome=outcome,
        box=None if box is None else _box(box),
        since_us=None if since is None else to_us(_utc(since)),
        until_us=None if until is None else to_us(_utc(until)),
        deleted=deleted,
    )
    digests = await services.journal.page(limit + 1, None if after is None else _place(after), wanted)
    shown, more = digests[:limit], len(digests) > limit
    follow = f"{shown[-1].drafted_at_us}.{shown[-1].mission_id}" if more else None
    kept = await asyncio.to_thread(services.iq.sizes, [digest.mission_id for digest in shown])
    lines = [summary.mission_summary(digest, kept.get(digest.mission_id, 0)) for digest in shown]
    return MissionList(missions=lines, next=follow)


def _box(text: str) -> tuple[float, float, float, float]:
    west, south, east, north = (float(part) for part in text.split(","))
    return west, south, east, north


def _utc(at: datetime) -> datetime:
    return at if at.tzinfo is not None else at.replace(tzinfo=UTC)


def _place(after: str) -> PlaceInList:
    drafted_at_us, mission_id = after.split(".")
    return PlaceInList(int(drafted_at_us), mission_id)


@router.post("", status_code=201)
async def create_mission(
    spec: MissionSpec, services: ServicesDep, principal: PrincipalDep, mission_id: UUID | None = None
) -> Mission:
    """Draft a mission. The errors of bearings are estimated with the place unless the request says otherwise.
    mission_id: chosen by who asks, who may then ask again when no answer came: 409 where it was drafted."""
    spec = with_errors_said(spec)
    wanted = None if mission_id is None else str(mission_id)
    return await _mission(services, await services.missions.drafts.create(spec, principal.name, wanted))


@router.get("/{mission_id}")
async def get_mission(mission_id: MissionId, services: ServicesDep) -> Mission:
    """One mission as the journal tells it."""
    return await _mission(services, mission_id)


@router.put("/{mission_id}/spec")
async def edit_mission(
    mission_id: MissionId,
    spec: MissionSpec,
    services: ServicesDep,
    principal: PrincipalDep,
    from_seq: Annotated[int | None, Query(ge=1)] = None,
) -> Mission:
    """Replace the specification of a draft; 409 once the mission has started. from_seq: `spec_seq` of what was edited,
    409 when somebody has saved another one since; without it theirs is replaced unseen. What the request does not say
    of the errors of bearings, and of what a sweep tells, stays as it was."""
    before = (await _mission(services, mission_id)).spec.sensor
    await services.missions.drafts.edit(mission_id, with_errors_said(spec, before), principal.name, from_seq)
    return await _mission(services, mission_id)


@router.post("/{mission_id}/commands")
async def send_command(
    mission_id: MissionId,
    request: CommandRequest,
    http: Request,
    services: ServicesDep,
    principal: PrincipalDep,
    meters: MetersDep,
) -> CommandReply:
    """Ask something of the mission. Idempotent by `command_id`; a refusal is a reply with accepted = false. Where there
    are accounts, what steers needs the control lease and its `fence`; hold, abort, return and landing never do."""
    access, flights = services.access, services.missions.flights
    permit(access, principal, request)
    with about(mission=mission_id, command=str(request.command_id)):
        answer = flights.command(mission_id, request, principal.author, access.people.operates)
        reply = await ordered(access, principal, http, request, answer)
        meters.count_command(request.command.kind, reply)
    return reply


@router.post("/{mission_id}/preflight")
async def run_preflight(mission_id: MissionId, services: ServicesDep, principal: PrincipalDep) -> PreflightReply:
    """Run the checklist and record it."""
    checked = await services.missions.drafts.preflight(mission_id)
    return PreflightReply(passed=checked.passed, checks=checked.checks)


@router.post("/{mission_id}/antenna-check")
async def check_antenna(
    mission_id: MissionId, request: AntennaCheckRequest, services: ServicesDep, principal: PrincipalDep
) -> CheckFact:
    """Listen while the vehicle is turned once around by hand before a known emitter; the result joins the checklist.
    409 while anything flies."""
    emitter = request.place if request.place is not None else request.bearing_deg or 0.0
    checked = await services.missions.drafts.check_antenna(mission_id, emitter, request.wait_s, principal.name)
    return checked.check
