"""What holds for every command: who may give it, how often, and its line in the audit log."""

from __future__ import annotations

from collections.abc import Awaitable

from fastapi import Request

from backend.api.problems import ApiProblem
from backend.auth.access import Access
from backend.auth.limits import too_many
from backend.auth.principal import Principal
from backend.commands import CommandReply, CommandRequest, CraftRequest
from backend.permissions import COMMANDS, SAFETY, Need
from backend.reasons.access import CallNotListed


def permit(access: Access, principal: Principal, request: CommandRequest | CraftRequest) -> None:
    """Whoever had too many commands refused waits, but never with what stops or lands the vehicle.

    Raises ApiProblem 403, Denied 429.
    """
    need = COMMANDS.get(request.command.kind)
    if need is None:
        raise ApiProblem(403, CallNotListed())
    refused = principal.refused(Need(need.role))
    if refused is not None:
        access.limits.command_refused(principal)
        raise ApiProblem(403, refused)
    if need is not SAFETY and (wait_s := access.limits.command_wait_s(principal)) > 0:
        raise too_many(wait_s)


async def ordered(
    access: Access,
    principal: Principal,
    http: Request,
    request: CommandRequest | CraftRequest,
    answer: Awaitable[CommandReply],
) -> CommandReply:
    """The answer, with what was ordered and what became of it in the audit log."""
    about = {"command": request.command.kind, "command_id": str(request.command_id)}
    http.state.audit.update(about)
    reply = await answer
    http.state.audit["accepted"] = reply.accepted
    if reply.reason is not None:
        http.state.audit["reason"] = reply.reason.code
        access.limits.command_refused(principal)
    return reply
