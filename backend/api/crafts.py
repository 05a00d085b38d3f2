"""Orders to a vehicle in the air (hold, return, land), whether it flies for a mission or not."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path, Request

from backend.api.dependencies import MetersDep, PrincipalDep, ServicesDep
from backend.api.ordering import ordered, permit
from backend.api.problems import PROBLEM_RESPONSES, not_found
from backend.commands import CommandReply, CraftRequest
from backend.logs import about

CraftId = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,40}$", description="The craft's id")]
router = APIRouter(prefix="/api/crafts", tags=["crafts"], responses=PROBLEM_RESPONSES)


@router.post("/{craft_id}/commands")
async def order_craft(
    craft_id: CraftId,
    request: CraftRequest,
    http: Request,
    services: ServicesDep,
    principal: PrincipalDep,
    meters: MetersDep,
) -> CommandReply:
    """Idempotent by `command_id`. A refusal is a reply with accepted = false; seq is 0 without a mission."""
    access, flights = services.access, services.missions.flights
    permit(access, principal, request)
    if craft_id not in flights.loose:
        raise not_found("craft", craft_id)
    with about(craft=craft_id, command=str(request.command_id)):
        answer = flights.command_craft(craft_id, request, principal.author)
        reply = await ordered(access, principal, http, request, answer)
        meters.count_command(request.command.kind, reply)
    return reply
