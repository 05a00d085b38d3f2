"""Missions: drafted, edited, checked, commanded."""

from __future__ import annotations

from fastapi import APIRouter, Request

from backend.api import summary
from backend.api.dependencies import MissionId, PrincipalDep, ServicesDep
from backend.api.ordering import ordered, permit
from backend.api.problems import PROBLEM_RESPONSES
from backend.api.services import Services
from backend.commands import CommandReply, CommandRequest
from backend.events import CheckFact
from backend.search.errors import MissionNotFound
from backend.spec import MissionSpec
from backend.store.digest import MissionDigest
from backend.wire.resources import AntennaCheckRequest, Mission, MissionList, PreflightReply

router = APIRouter(prefix="/api/missions", tags=["missions"], responses=PROBLEM_RESPONSES)


async def stored_mission(services: Services, mission_id: str) -> MissionDigest:
    """Raises MissionNotFound."""
    digest = await services.journal.mission(mission_id)
    if digest is None:
        raise MissionNotFound(mission_id)
    return digest


async def _mission(services: Services, mission_id: str) -> Mission:
    digest = await stored_mission(services, mission_id)
    return summary.mission(digest, await services.journal.read_kinds(mission_id, summary.DETAIL_KINDS))


@router.get("")
async def list_missions(services: ServicesDep) -> MissionList:
    """All missions, newest first."""
    return MissionList(missions=[summary.mission_summary(digest) for digest in await services.journal.missions()])


@router.post("", status_code=201)
async def create_mission(spec: MissionSpec, services: ServicesDep, principal: PrincipalDep) -> Mission:
    """Draft a mission."""
    return await _mission(services, await services.missions.drafts.create(spec, principal.name))


@router.get("/{mission_id}")
async def get_mission(mission_id: MissionId, services: ServicesDep) -> Mission:
    """One mission as the journal tells it."""
    return await _mission(services, mission_id)


@router.put("/{mission_id}/spec")
async def edit_mission(
    mission_id: MissionId, spec: MissionSpec, services: ServicesDep, principal: PrincipalDep
) -> Mission:
    """Replace the specification of a draft; 409 once the mission has started."""
    await services.missions.drafts.edit(mission_id, spec, principal.name)
    return await _mission(services, mission_id)


@router.post("/{mission_id}/commands")
async def send_command(
    mission_id: MissionId, request: CommandRequest, http: Request, services: ServicesDep, principal: PrincipalDep
) -> CommandReply:
    """Ask something of the mission. Idempotent by `command_id`; a refusal is a reply with accepted = false. Where there
    are accounts, what steers needs the control lease and its `fence`; hold, abort, return and landing never do."""
    access, flights = services.access, services.missions.flights
    permit(access, principal, request)
    answer = flights.command(mission_id, request, principal.author, access.operates)
    return await ordered(access, principal, http, request, answer)


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
