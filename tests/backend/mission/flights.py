"""A mission brought to where a test of the service begins."""

from __future__ import annotations

from uuid import uuid4

from doubles import Stage, spec

from backend import commands
from backend.commands import Command, CommandReply, CommandRequest


async def order(stage: Stage, mission_id: str, command: Command) -> CommandReply:
    return await stage.service.command(mission_id, CommandRequest(command_id=uuid4(), command=command), "anna")


async def flying(stage: Stage, phase: str = "flying", **flight: object) -> str:
    mission_id = await stage.service.create(spec(**flight), "anna")
    reply = await order(stage, mission_id, commands.Start())
    assert reply.accepted, reply.reason
    await stage.until_phase(mission_id, phase)
    return mission_id


async def stuck(stage: Stage) -> str:
    """A mission whose flight to the first place never ends."""
    mission_id = await stage.service.create(spec(), "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted
    await stage.until(mission_id, "took_off")
    stage.vehicle.stuck = True
    await stage.until(mission_id, "flight_started")
    await stage.until_true(lambda: "goto" in stage.vehicle.names)
    return mission_id
