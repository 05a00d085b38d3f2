"""A mission brought to where a test of its flight begins."""

from __future__ import annotations

from uuid import uuid4

from equipment import spec
from stage import Stage

from backend import commands
from backend.commands import Command, CommandReply, CommandRequest


async def order(stage: Stage, mission_id: str, command: Command) -> CommandReply:
    request = CommandRequest(command_id=uuid4(), command=command)
    return await stage.room.flights.command(mission_id, request, commands.Author("anna"))


async def flying(stage: Stage, phase: str = "flying", **flight: object) -> str:
    mission_id = await stage.room.drafts.create(spec(**flight), "anna")  # type: ignore[arg-type]
    reply = await order(stage, mission_id, commands.Start())
    assert reply.accepted, reply.reason
    await stage.until_phase(mission_id, phase)
    return mission_id


async def stuck(stage: Stage) -> str:
    """A mission whose flight to the first place never ends."""
    mission_id = await stage.room.drafts.create(spec(), "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted
    await stage.until(mission_id, "took_off")
    stage.vehicle.stuck = True
    await stage.until(mission_id, "flight_started")
    await stage.until_true(lambda: "goto" in stage.vehicle.names)
    return mission_id
