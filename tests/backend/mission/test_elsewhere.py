"""The search area changed in flight: in hold only, the bearings count on, and nothing moves by it."""

from __future__ import annotations

from dataclasses import replace
from uuid import uuid4

import pytest
from doubles import FRAME, Stage, spec
from flights import flying, order, stuck
from missions import ELSEWHERE, PHASES, SPEC, VETO, Walk, answer, bearing, belief_ready, kinds, plan, walk_in

from backend import commands
from backend.commands import CommandRequest
from backend.events import AreaChanged, BeliefUpdated, PlanChosen
from backend.mission import effects as asked
from backend.mission import inputs
from backend.mission.errors import MissionConflict, MissionInputError, MissionNotFound
from backend.mission.state import fold
from backend.spec import Polygon, SearchArea, UniformPriorSpec

CHANGE = commands.ChangeArea(search=ELSEWHERE)


def rectangle(west: float, south: float, east: float, north: float) -> Polygon:
    corners = [
        FRAME.to_geo(x, y) for x, y in ((west, south), (east, south), (east, north), (west, north), (west, south))
    ]
    return Polygon(coordinates=[[(c.lon_deg, c.lat_deg) for c in corners]])


def search(area: Polygon, fence: Polygon | None = None, no_fly: tuple[Polygon, ...] = ()) -> SearchArea:
    return SearchArea(area=area, prior=UniformPriorSpec(), fence=fence, fence_margin_m=60.0, no_fly=list(no_fly))


NORTHWARD = search(rectangle(-60, -20, 140, 200))


@pytest.mark.parametrize("phase", PHASES)
def test_the_area_changes_in_hold_only_and_moves_nothing(phase: str) -> None:
    walk = walk_in(phase)
    before = walk.state
    effects = walk.command(CHANGE)
    if phase == "hold":
        assert kinds(effects)[:3] == [asked.Record, asked.SearchElsewhere, asked.UpdateBelief]
        assert walk.state.spec == SPEC.searching(ELSEWHERE)
    else:
        assert kinds(effects) == [asked.Record, asked.Reply]
        assert answer(effects).remedy
        assert walk.state.spec == before.spec
    assert walk.state.phase == phase


def test_bearings_count_on_and_what_was_planned_for_the_old_area_is_void() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1)))
    walk.give(belief_ready(walk.state))
    walk.give(inputs.Planned(plan(2)))
    walk.command(commands.SetAutomatic(automatic=False))
    walk.command(commands.Hold())
    walk.command(CHANGE)
    assert walk.state.bearing_ids == ("b1",)
    assert (walk.state.chosen, walk.state.belief_current, walk.state.automatic) == (None, False, False)
    walk.give(belief_ready(walk.state))
    assert walk.command(commands.Resume())[-3] == asked.PlanNext(3, ())
    assert fold(walk.recorded) == walk.state


def test_a_mission_localized_in_the_old_area_is_not_in_the_new_one_until_its_belief_says_so() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1)))
    walk.give(belief_ready(walk.state, localized=True))
    assert walk.state.localized
    walk.command(commands.Hold())
    walk.command(CHANGE)
    assert not walk.state.localized
    assert walk.state.localized_at_s is None


def test_objections_refuse_the_change_and_become_facts() -> None:
    walk = Walk().to("hold")
    effects = walk.command(CHANGE, objections=(VETO,))
    assert (answer(effects).accepted, answer(effects).reason, answer(effects).remedy) == (
        False, VETO.detail, VETO.remedy,
    )  # fmt: skip
    assert walk.state.spec == SPEC
    assert walk.kinds[-2:] == ["safety_vetoed", "command_refused"]


async def held(stage: Stage) -> str:
    mission_id = await flying(stage)
    await stage.until(mission_id, "bearing_measured")
    assert (await order(stage, mission_id, commands.Hold())).accepted
    await stage.until_true(lambda: fold(stage.journal.stored[mission_id]).belief_current)
    return mission_id


async def test_the_next_place_is_sought_in_the_new_area_and_a_restart_finds_it_again(stage: Stage) -> None:
    mission_id = await held(stage)
    beliefs = stage.journal.kinds(mission_id).count("belief_updated")
    assert (await order(stage, mission_id, commands.ChangeArea(search=NORTHWARD))).accepted
    after = await stage.until(mission_id, "belief_updated", beliefs + 1)
    assert isinstance(after, BeliefUpdated)
    assert AreaChanged(search=NORTHWARD, by="anna") in stage.journal.events(mission_id)

    await stage.service.shut_down()
    stage.service = stage.new_service()
    await stage.service.start_up()
    again = await stage.until(mission_id, "belief_updated", beliefs + 2)
    assert isinstance(again, BeliefUpdated)
    assert again.digest == after.digest

    plans = stage.journal.kinds(mission_id).count("plan_chosen")
    assert (await order(stage, mission_id, commands.Resume())).accepted
    found = await stage.until(mission_id, "plan_chosen", plans + 1)
    assert isinstance(found, PlanChosen)


async def test_a_place_outside_the_new_fence_is_refused_and_one_outside_the_old_is_not(stage: Stage) -> None:
    mission_id = await held(stage)
    north = FRAME.to_geo(40, 240)
    far = commands.Override(place={"lat": north.lat_deg, "lon": north.lon_deg})  # type: ignore[arg-type]
    assert "outside the fence" in (await order(stage, mission_id, far)).reason
    assert (await order(stage, mission_id, commands.ChangeArea(search=NORTHWARD))).accepted
    assert (await order(stage, mission_id, far)).accepted


@pytest.mark.parametrize(
    ("wanted", "reason"),
    [
        (search(rectangle(1_000, 1_000, 1_300, 1_300)), "home is 1"),
        (search(rectangle(-60, -20, 140, 200), no_fly=(rectangle(-9, -9, 9, 9),)), "home is inside a no-fly zone"),
        (search(rectangle(0, 0, 5, 5)), "the area has only 25 m2"),
        (search(rectangle(20_000, 0, 20_300, 300)), "km away from the vehicle"),
        (search(rectangle(0, 0, 9_000, 300)), "9.0 km wide"),
        (search(Polygon(coordinates=[])), "the area is empty"),
    ],
)
async def test_an_area_that_cannot_be_searched_from_here_is_refused_and_nothing_changes(
    stage: Stage, wanted: SearchArea, reason: str
) -> None:
    mission_id = await held(stage)
    reply = await order(stage, mission_id, commands.ChangeArea(search=wanted))
    assert not reply.accepted
    assert reason in reply.reason
    assert reply.remedy
    assert "area_changed" not in stage.journal.kinds(mission_id)
    resumed = await order(stage, mission_id, commands.Resume())
    assert resumed.accepted


async def test_a_vehicle_outside_the_new_fence_forbids_it(stage: Stage) -> None:
    mission_id = await stuck(stage)
    stage.vehicle.stuck = False
    assert (await order(stage, mission_id, commands.Hold())).accepted
    stage.vehicle.state = replace(stage.vehicle.state, position=FRAME.to_geo(100.0, 0.0))
    small = search(rectangle(-20, -20, 30, 30), fence=rectangle(-30, -30, 40, 40))
    reply = await order(stage, mission_id, commands.ChangeArea(search=small))
    assert not reply.accepted
    assert "the vehicle is 60 m outside the fence" in reply.reason


async def test_the_same_change_ordered_again_gets_the_first_answer(stage: Stage) -> None:
    mission_id = await held(stage)
    request = CommandRequest(command_id=uuid4(), command=commands.ChangeArea(search=NORTHWARD))
    first = await stage.service.command(mission_id, request, "anna")
    assert (await stage.service.command(mission_id, request, "anna")).accepted == first.accepted is True
    assert stage.journal.kinds(mission_id).count("area_changed") == 1


async def test_the_outlook_tells_what_the_bearings_say_there_and_changes_nothing(stage: Stage) -> None:
    mission_id = await held(stage)
    recorded = len(stage.journal.events(mission_id))
    found = await stage.service.outlook(mission_id, NORTHWARD)
    assert not found.vetoes
    assert found.belief.bearings >= 1
    assert (found.plan is None) == bool(found.no_plan)
    away = await stage.service.outlook(mission_id, search(rectangle(1_000, 1_000, 1_300, 1_300)))
    assert away.vetoes[0].rule == "fence"
    with pytest.raises(MissionInputError):
        await stage.service.outlook(mission_id, search(Polygon(coordinates=[])))
    assert len(stage.journal.events(mission_id)) == recorded


async def test_there_is_no_outlook_for_what_does_not_fly(stage: Stage) -> None:
    draft = await stage.service.create(spec(), "anna")
    with pytest.raises(MissionConflict):
        await stage.service.outlook(draft, NORTHWARD)
    with pytest.raises(MissionNotFound):
        await stage.service.outlook("nobody", NORTHWARD)
    reply = await order(stage, draft, CHANGE)
    assert (reply.accepted, reply.remedy) == (False, "edit the draft")
