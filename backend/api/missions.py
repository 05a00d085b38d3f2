"""Missions: drafted, edited, checked, commanded."""

from __future__ import annotations

from fastapi import APIRouter

from backend.api.dependencies import MissionId, PrincipalDep, ServicesDep
from backend.api.problems import PROBLEM_RESPONSES
from backend.commands import CommandReply, CommandRequest
from backend.spec import MissionSpec
from backend.wire.resources import Mission, MissionList, PreflightReply

router = APIRouter(prefix="/api/missions", tags=["missions"], responses=PROBLEM_RESPONSES)


@router.get("")
async def list_missions(services: ServicesDep) -> MissionList:
    """All missions, newest first."""
    raise NotImplementedError


@router.post("", status_code=201)
async def create_mission(spec: MissionSpec, services: ServicesDep, principal: PrincipalDep) -> Mission:
    """Draft a mission."""
    raise NotImplementedError


@router.get("/{mission_id}")
async def get_mission(mission_id: MissionId, services: ServicesDep) -> Mission:
    """One mission as the journal tells it."""
    raise NotImplementedError


@router.put("/{mission_id}/spec")
async def edit_mission(
    mission_id: MissionId, spec: MissionSpec, services: ServicesDep, principal: PrincipalDep
) -> Mission:
    """Replace the specification of a draft; 409 once the mission has started."""
    raise NotImplementedError


@router.post("/{mission_id}/commands")
async def send_command(
    mission_id: MissionId, request: CommandRequest, services: ServicesDep, principal: PrincipalDep
) -> CommandReply:
    """Ask something of the mission. Idempotent by `command_id`; a refusal is a reply with accepted = false."""
    raise NotImplementedError


@router.post("/{mission_id}/preflight")
async def run_preflight(mission_id: MissionId, services: ServicesDep, principal: PrincipalDep) -> PreflightReply:
    """Run the checklist and record it."""
    raise NotImplementedError
