"""A server that ends leaves nothing flying by itself, and a vehicle in the air without a mission starts none."""

from __future__ import annotations

from dataclasses import replace
from uuid import uuid4

import pytest
from equipment import spec
from flights import flying, order
from stage import Stage

from backend import commands
from backend.events import FIRST_CRAFT, HoldOrdered
from backend.reasons.access import ControlHeld, ControlStale
from backend.reasons.flight import ServerEnds
from backend.reasons.refusals import AnotherMissionFlies, ServerIsEnding
from backend.reasons.safety import AlreadyInAir
from hardware.ports import VehicleError
from hardware.reasons.vehicle import AutopilotRefused, DoesNotHold


async def test_what_flies_by_itself_is_held_and_confirmed_before_the_server_ends(stage: Stage) -> None:
    mission_id = await flying(stage)
    (left,) = await stage.room.flights.leave(5.0)
    assert (left.craft_id, left.phase, left.who, left.confirmed) == (FIRST_CRAFT, "hold", "ours", True)
    assert stage.vehicle.names[-1] == "hold"
    await stage.until(mission_id, "order_done")
    assert stage.journal.of_kind(mission_id, HoldOrdered)[-1].reason == ServerEnds()


@pytest.mark.parametrize("before", [commands.Hold(), commands.Land()])
async def test_what_is_held_or_lands_by_itself_is_left_so(stage: Stage, before: commands.ForCraft) -> None:
    mission_id = await flying(stage)
    await order(stage, mission_id, before)
    await stage.until(mission_id, "order_done")
    sent = list(stage.vehicle.names)
    (left,) = await stage.room.flights.leave(5.0)
    assert left.confirmed
    assert stage.vehicle.names == sent


async def coming_home(stage: Stage) -> None:
    """By our own way points, on the way to the first of them."""
    mission_id = await flying(stage, "measuring")
    stage.vehicle.stuck = True
    legs = stage.vehicle.names.count("goto")
    await order(stage, mission_id, commands.Return())
    await stage.until_phase(mission_id, "returning")
    await stage.until_true(lambda: stage.vehicle.names.count("goto") > legs)
    stage.vehicle.stuck = False


async def test_a_return_by_our_own_way_points_is_held(stage: Stage) -> None:
    """It would stand still at the next of them, and no autopilot brings it home from there but by its failsafe."""
    await coming_home(stage)
    (left,) = await stage.room.flights.leave(5.0)
    assert (left.phase, left.confirmed) == ("hold", True)
    assert stage.vehicle.names[-1] == "hold"


async def test_a_return_that_the_autopilot_flies_is_left_to_it(stage: Stage) -> None:
    await coming_home(stage)
    stage.vehicle.control.restore(replace(stage.vehicle.control.authority, kind="return"))
    (left,) = await stage.room.flights.leave(0.3)
    assert left.phase == "returning"
    assert stage.vehicle.names[-1] == "goto"


async def test_a_vehicle_that_refuses_every_order_is_left_to_its_failsafe(stage: Stage) -> None:
    await flying(stage)
    closed: list[bool] = []

    async def refuse() -> None:
        raise VehicleError(DoesNotHold(AutopilotRefused("hold", "denied")))

    async def close() -> None:
        closed.append(True)

    stage.vehicle.hold = stage.vehicle.return_home = stage.vehicle.land = refuse  # type: ignore[method-assign]
    stage.vehicle.close = close  # type: ignore[method-assign]
    (left,) = await stage.room.flights.leave(0.3)
    assert not left.confirmed
    assert closed == [True]


async def test_while_the_server_ends_nothing_goes_on(stage: Stage) -> None:
    mission_id = await flying(stage)
    await stage.room.flights.leave(5.0)
    refused = await order(stage, mission_id, commands.Resume())
    assert (refused.accepted, refused.reason) == (False, ServerIsEnding())
    assert (await order(stage, mission_id, commands.Return())).accepted


async def test_no_mission_starts_with_a_vehicle_in_the_air(stage: Stage) -> None:
    stage.vehicle.state = replace(stage.vehicle.state, armed=True, in_air=True, altitude_relative_m=40.0)
    mission_id = await stage.room.drafts.create(spec(), "anna")
    refused = await order(stage, mission_id, commands.Start())
    assert (refused.accepted, refused.reason) == (False, AlreadyInAir())


async def test_one_door_reaches_a_craft_with_a_mission_and_without(stage: Stage) -> None:
    flights = stage.room.flights
    mission_id = await flying(stage)
    held = await flights.command_craft(
        FIRST_CRAFT, commands.CraftRequest(command_id=uuid4(), command=commands.Hold()), commands.Author("anna")
    )
    assert held.accepted
    await stage.until_phase(mission_id, "hold")
    other = await stage.room.drafts.create(spec(), "anna")
    refused = await order(stage, other, commands.Start())
    assert isinstance(refused.reason, AnotherMissionFlies)


async def test_the_same_door_reaches_a_craft_in_no_mission(stage: Stage) -> None:
    stage.vehicle.state = replace(stage.vehicle.state, armed=True, in_air=True, altitude_relative_m=40.0)
    landed = await stage.room.flights.command_craft(
        FIRST_CRAFT, commands.CraftRequest(command_id=uuid4(), command=commands.Land()), commands.Author("anna")
    )
    assert landed.accepted
    await stage.until_true(lambda: stage.vehicle.names == ["land"])


async def test_a_craft_in_no_mission_is_named_and_held_on_its_way(stage: Stage) -> None:
    stage.vehicle.state = replace(stage.vehicle.state, armed=True, in_air=True, altitude_relative_m=40.0)
    flights, loose = stage.room.flights, stage.room.flights.loose[FIRST_CRAFT]
    loose.tick()
    (left,) = await flights.leave(5.0)
    assert (left.craft_id, left.who, left.confirmed) == (FIRST_CRAFT, "nobody", True)
    assert stage.vehicle.names == [], "nothing is sent to what nobody ordered anywhere"
    held = await flights.command_craft(
        FIRST_CRAFT, commands.CraftRequest(command_id=uuid4(), command=commands.Hold()), commands.Author("anna")
    )
    assert held.accepted
    (left,) = await flights.leave(5.0)
    assert (left.phase, left.who, left.confirmed) == ("hold", "ours", True)


async def test_the_door_to_a_craft_does_not_pass_by_its_missions_control(stage: Stage) -> None:
    """A resume to the craft steers the search that it flies for; a hold stops it, whoever controls."""
    flights = stage.room.flights
    mission_id = await flying(stage)
    anna, ben = (commands.Author(name, f"p-{name}", "operator") for name in ("anna", "ben"))

    async def to_craft(command: commands.Hold | commands.Resume, author: commands.Author, fence: int | None = None):
        request = commands.CraftRequest(command_id=uuid4(), command=command, fence=fence)
        return (await flights.command_craft(FIRST_CRAFT, request, author)).reason

    take = commands.CommandRequest(command_id=uuid4(), command=commands.TakeControl())
    assert (await flights.command(mission_id, take, anna)).accepted
    assert await to_craft(commands.Hold(), ben) is None
    await stage.until_phase(mission_id, "hold")
    assert await to_craft(commands.Resume(), ben, 1) == ControlHeld("anna")
    assert await to_craft(commands.Resume(), anna) == ControlStale()
    assert await to_craft(commands.Resume(), anna, 1) is None


async def test_control_whose_holder_is_shut_out_is_free_to_operators(stage: Stage) -> None:
    flights = stage.room.flights
    mission_id = await stage.room.drafts.create(spec(), "anna")
    anna, ben = (commands.Author(name, f"p-{name}", "operator") for name in ("anna", "ben"))

    async def take(author: commands.Author, operates: bool):
        request = commands.CommandRequest(command_id=uuid4(), command=commands.TakeControl())
        return (await flights.command(mission_id, request, author, lambda _: operates)).reason

    assert await take(anna, True) is None
    assert await take(ben, True) == ControlHeld("anna")
    assert await take(ben, False) is None
