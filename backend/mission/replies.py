"""What a command is answered, from what the mission made of it."""

from __future__ import annotations

from backend.commands import CommandReply, CommandRequest, CraftRequest
from backend.mission.effects import Effect, Reply
from backend.reasons import Reason


def reply(request: CommandRequest | CraftRequest, reason: Reason | None, seq: int = 0) -> CommandReply:
    """reason: why it is refused. seq: 0: nothing of it is in the journal."""
    return CommandReply(command_id=request.command_id, accepted=reason is None, reason=reason, seq=seq)


def refusal(asked: tuple[Effect, ...]) -> Reason | None:
    """Why the mission refused the command that it was given; None: it accepted it."""
    return next(effect for effect in asked if isinstance(effect, Reply)).reason
