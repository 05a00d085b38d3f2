"""An order that a bad link has held up does not undo the next one of its page; the others count whenever they come."""

from __future__ import annotations

from dataclasses import replace
from uuid import UUID, uuid4

import pytest
from flights import stuck
from stage import Stage

from backend import commands
from backend.commands import Author, Command, CommandReply, CommandRequest, Press
from backend.events import FIRST_CRAFT
from backend.mission.presses import MOST_PAGES, Presses
from backend.reasons.refusals import LaterOrderCounts

PAGE = uuid4()


def press(number: int, page: object = PAGE) -> Press:
    return Press.model_validate({"page": page, "number": number})


async def ordered(stage: Stage, mission_id: str, command: Command, number: int, page: object = PAGE) -> CommandReply:
    request = CommandRequest(command_id=uuid4(), command=command, press=press(number, page))
    return await stage.room.flights.command(mission_id, request, Author("anna"))


@pytest.mark.parametrize("older", [commands.Return(), commands.Land(), commands.Hold(), commands.Resume()])
async def test_an_order_that_comes_after_a_later_one_is_refused_and_does_nothing(stage: Stage, older: Command) -> None:
    mission_id = await stuck(stage)
    assert (await ordered(stage, mission_id, commands.Hold(), 2)).accepted
    kinds = stage.journal.kinds(mission_id)
    late = await ordered(stage, mission_id, older, 1)
    assert (late.accepted, late.reason) == (False, LaterOrderCounts())
    assert stage.journal.kinds(mission_id) == kinds
    assert stage.journal.state(mission_id).phase == "hold"


async def test_of_orders_in_their_order_each_is_carried_out(stage: Stage) -> None:
    mission_id = await stuck(stage)
    assert (await ordered(stage, mission_id, commands.Hold(), 1)).accepted
    assert (await ordered(stage, mission_id, commands.Return(), 2)).accepted
    assert (await ordered(stage, mission_id, commands.Hold(), 3)).accepted
    assert stage.journal.kinds(mission_id).count("hold_ordered") == 2


async def test_an_abort_never_comes_too_late_and_what_was_given_before_it_does(stage: Stage) -> None:
    mission_id = await stuck(stage)
    assert (await ordered(stage, mission_id, commands.Hold(), 3)).accepted
    assert (await ordered(stage, mission_id, commands.Abort(), 2)).accepted
    assert (await ordered(stage, mission_id, commands.Hold(), 1)).reason == LaterOrderCounts()
    assert stage.journal.kinds(mission_id).count("abort_ordered") == 1


async def test_an_order_of_another_page_or_of_none_counts_when_it_comes(stage: Stage) -> None:
    mission_id = await stuck(stage)
    assert (await ordered(stage, mission_id, commands.Return(), 9)).accepted
    assert (await ordered(stage, mission_id, commands.Hold(), 1, uuid4())).accepted
    assert (await ordered(stage, mission_id, commands.Return(), 10)).accepted
    unnumbered = CommandRequest(command_id=uuid4(), command=commands.Hold())
    assert (await stage.room.flights.command(mission_id, unnumbered, Author("anna"))).accepted


async def test_a_refused_order_leaves_the_one_before_it_its_chance(stage: Stage) -> None:
    mission_id = await stuck(stage)
    assert not (await ordered(stage, mission_id, commands.Resume(), 2)).accepted, "nothing is held"
    assert (await ordered(stage, mission_id, commands.Hold(), 1)).accepted


async def test_what_was_accepted_in_time_gets_its_answer_again(stage: Stage) -> None:
    mission_id = await stuck(stage)
    first = CommandRequest(command_id=uuid4(), command=commands.Return(), press=press(1))
    assert (await stage.room.flights.command(mission_id, first, Author("anna"))).accepted
    assert (await ordered(stage, mission_id, commands.Hold(), 2)).accepted
    assert (await stage.room.flights.command(mission_id, first, Author("anna"))).accepted
    assert stage.journal.state(mission_id).phase == "hold"


def test_an_order_to_all_is_late_only_when_each_craft_has_a_later_one() -> None:
    presses = Presses()
    presses.accepted(press(5), commands.Resume(craft_id="a"), ["a"])
    assert presses.is_late(press(4), commands.Hold(), ["a"])
    assert not presses.is_late(press(4), commands.Hold(), ["a", "b"])
    presses.accepted(press(6), commands.Hold(), ["a", "b"])
    assert presses.is_late(press(4), commands.Hold(), ["a", "b"])
    assert not presses.is_late(press(6), commands.Hold(), ["a", "b"]), "sent again"


def test_pages_that_ordered_nothing_for_longest_are_forgotten_first() -> None:
    presses, pages = Presses(), [uuid4() for _ in range(MOST_PAGES + 1)]
    for page in (*pages[:MOST_PAGES], pages[0], pages[-1]):
        presses.accepted(press(2, page), commands.Hold(), ["a"])
    late = [page for page in pages if presses.is_late(press(1, page), commands.Hold(), ["a"])]
    assert late == [pages[0], *pages[2:]]


async def test_it_is_so_for_a_craft_in_no_mission(stage: Stage) -> None:
    stage.vehicle.state = replace(stage.vehicle.state, armed=True, in_air=True, altitude_relative_m=40.0)

    async def to_craft(command: commands.Hold | commands.Land, number: int, command_id: UUID) -> CommandReply:
        request = commands.CraftRequest(command_id=command_id, command=command, press=press(number))
        return await stage.room.flights.command_craft(FIRST_CRAFT, request, Author("anna"))

    held = uuid4()
    assert (await to_craft(commands.Hold(), 1, held)).accepted
    assert (await to_craft(commands.Land(), 3, uuid4())).accepted
    assert (await to_craft(commands.Hold(), 2, uuid4())).reason == LaterOrderCounts()
    assert (await to_craft(commands.Hold(), 1, held)).accepted, "the answer of before"
    await stage.until_true(lambda: stage.vehicle.names[-1:] == ["land"])


async def test_the_door_to_a_craft_and_that_to_its_mission_count_together(stage: Stage) -> None:
    mission_id = await stuck(stage)
    assert (await ordered(stage, mission_id, commands.Hold(), 2)).accepted
    request = commands.CraftRequest(command_id=uuid4(), command=commands.Return(), press=press(1))
    late = await stage.room.flights.command_craft(FIRST_CRAFT, request, Author("anna"))
    assert late.reason == LaterOrderCounts()
