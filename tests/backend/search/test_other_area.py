"""The search area changed in flight: in hold only, the bearings count on, and nothing moves by it."""

from __future__ import annotations

import math
from dataclasses import replace
from uuid import uuid4

import pytest
from equipment import FRAME, spec
from facts import OTHER_AREA, SPEC, VETO, bearing, plan
from flights import flying, order, stuck
from refusals import near
from stage import Stage
from walks import PHASES, Walk, answer, refusal, sent, walk_in

from backend import commands
from backend.commands import CommandRequest
from backend.craft import effects as craft_effects
from backend.craft import inputs as craft_inputs
from backend.events import AreaChanged, BeliefUpdated, PlanChosen
from backend.mission.effects import OfCraft
from backend.mission.inputs import Context
from backend.mission.state import fold
from backend.reasons import search as reasons
from backend.reasons.refusals import AreaOnlyInHold, MissionDoesNotFly, MissionOver, NoSuchEmitter, NotStarted
from backend.reasons.safety import InsideNoFly, OutsideFence
from backend.search.effects import Record, SearchElsewhere, UpdateBelief
from backend.search.errors import MissionConflict, MissionInputError, MissionNotFound
from backend.spec import Polygon, SearchArea, UniformPriorSpec

CHANGE = commands.ChangeArea(search=OTHER_AREA)


def rectangle(west: float, south: float, east: float, north: float) -> Polygon:
    corners = [
        FRAME.to_geo(x, y) for x, y in ((west, south), (east, south), (east, north), (west, north), (west, south))
    ]
    return Polygon(coordinates=[[(c.lon, c.lat) for c in corners]])


def search(area: Polygon, fence: Polygon | None = None, no_fly: tuple[Polygon, ...] = ()) -> SearchArea:
    return SearchArea(area=area, priors={}, fence=fence, fence_margin_m=60.0, no_fly=list(no_fly))


NORTHWARD = search(rectangle(-60, -20, 140, 200))


@pytest.mark.parametrize("phase", PHASES)
def test_the_area_changes_in_hold_only_and_moves_nothing(phase: str) -> None:
    walk = walk_in(phase)
    before = walk.state
    asked = walk.command(CHANGE)
    if phase == "hold":
        done = [type(effect) for effect in asked]
        assert done.index(Record) < done.index(SearchElsewhere) < done.index(UpdateBelief)
        assert walk.search.spec == SPEC.searching(OTHER_AREA)
        assert answer(asked).reason is None
    else:
        assert isinstance(refusal(asked), REFUSED.get(phase, AreaOnlyInHold))
        assert walk.search.spec == before.search.spec
    assert sent(asked) == []
    assert walk.state.phase == before.phase


REFUSED: dict[str, type[object]] = {
    "draft": NotStarted,
    "ready": NotStarted,
    "done": MissionOver,
    "aborted": MissionOver,
    "aborted and down": MissionOver,
    "failed": MissionOver,
}
"""Elsewhere it is refused because nothing is held."""


def measured(localized: bool = False) -> Walk:
    """A craft that has taken its first bearing."""
    walk = Walk().to("measuring")
    walk.to_craft(craft_inputs.SweepTaken((bearing(1),)))
    walk.believe(localized)
    return walk


def test_bearings_count_on_and_what_was_planned_for_the_old_area_is_void() -> None:
    walk = measured()
    walk.to_craft(craft_inputs.Planned(plan(2)))
    walk.command(commands.SetAutomatic(automatic=False))
    walk.command(commands.Hold())
    walk.command(CHANGE)
    assert walk.search.emitters["emitter-1"].bearing_ids == ("b1",)
    assert (walk.craft.chosen, walk.search.beliefs_current, walk.craft.automatic) == (None, False, False)
    walk.believe()
    walk.to_craft(craft_inputs.NetsUp())
    resumed = [effect for effect in walk.command(commands.Resume()) if isinstance(effect, OfCraft)]
    (sought,) = [e.effect for e in resumed if isinstance(e.effect, craft_effects.PlanNext)]
    assert (sought.place_number, sought.avoid) == (3, ())
    assert fold(walk.recorded) == walk.state


def test_a_mission_localized_in_the_old_area_is_not_in_the_new_one_until_its_belief_says_so() -> None:
    walk = measured(localized=True)
    assert walk.search.localized
    walk.command(commands.Hold())
    walk.command(CHANGE)
    assert not walk.search.localized
    assert walk.search.localized_at_s is None


def test_objections_refuse_the_change_and_become_facts() -> None:
    walk = Walk().to("hold")
    asked = walk.command(CHANGE, Context(objections=(VETO,)))
    assert refusal(asked) == VETO
    assert walk.search.spec == SPEC
    assert walk.kinds[-1] == "command_refused"


def test_an_area_for_an_emitter_that_is_not_looked_for_is_refused() -> None:
    walk = Walk().to("hold")
    stranger = CHANGE.search.model_copy(update={"priors": {"emitter-9": UniformPriorSpec()}})
    assert refusal(walk.command(commands.ChangeArea(search=stranger))) == NoSuchEmitter("emitter-9")
    assert walk.search.spec == SPEC


async def held(stage: Stage) -> str:
    mission_id = await flying(stage)
    await stage.until(mission_id, "bearing_measured")
    assert (await order(stage, mission_id, commands.Hold())).accepted
    await stage.until(mission_id, "order_done")
    await stage.until_true(lambda: stage.journal.state(mission_id).search.beliefs_current)
    return mission_id


async def test_the_next_place_is_sought_in_the_new_area_and_a_restart_finds_it_again(stage: Stage) -> None:
    mission_id = await held(stage)
    beliefs = stage.journal.kinds(mission_id).count("belief_updated")
    assert (await order(stage, mission_id, commands.ChangeArea(search=NORTHWARD))).accepted
    after = await stage.until(mission_id, "belief_updated", beliefs + 1)
    assert isinstance(after, BeliefUpdated)
    assert AreaChanged(search=NORTHWARD, by="anna") in stage.journal.events(mission_id)

    await stage.restart()
    again = await stage.until(mission_id, "belief_updated", beliefs + 2)
    assert isinstance(again, BeliefUpdated)
    assert again.digest == after.digest

    plans = stage.journal.kinds(mission_id).count("plan_chosen")
    assert (await order(stage, mission_id, commands.Resume())).accepted
    found = await stage.until(mission_id, "plan_chosen", plans + 1)
    assert isinstance(found, PlanChosen)


async def test_a_place_outside_the_new_fence_is_refused_and_one_outside_the_old_is_not(stage: Stage) -> None:
    mission_id = await held(stage)
    far = commands.Override(place=FRAME.to_geo(40, 240))
    refused = (await order(stage, mission_id, far)).reason
    assert isinstance(refused, OutsideFence)
    assert refused.what == "place"
    assert (await order(stage, mission_id, commands.ChangeArea(search=NORTHWARD))).accepted
    assert (await order(stage, mission_id, far)).accepted


@pytest.mark.parametrize(
    ("wanted", "reason"),
    [
        (
            search(rectangle(1_000, 1_000, 1_300, 1_300)),
            OutsideFence("home", near(math.hypot(1_000, 1_000) - 60.0)),
        ),
        (search(rectangle(-60, -20, 140, 200), no_fly=(rectangle(-9, -9, 9, 9),)), InsideNoFly("home")),
        (search(rectangle(0, 0, 5, 5)), reasons.AreaTooSmall(near(25), 100.0)),
        (search(rectangle(20_000, 0, 20_300, 300)), reasons.AreaTooFar(near(20_000))),
        (search(rectangle(0, 0, 9_000, 300)), reasons.AreaTooWide(near(9_000), 5_000.0)),
        (search(Polygon(coordinates=[])), reasons.AreaEmpty("area")),
    ],
)
async def test_an_area_that_cannot_be_searched_from_here_is_refused_and_nothing_changes(
    stage: Stage, wanted: SearchArea, reason: object
) -> None:
    mission_id = await held(stage)
    reply = await order(stage, mission_id, commands.ChangeArea(search=wanted))
    assert not reply.accepted
    assert reply.reason == reason
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
    assert reply.reason == OutsideFence("vehicle", near(60.0))


async def test_the_same_change_ordered_again_gets_the_first_answer(stage: Stage) -> None:
    mission_id = await held(stage)
    request = CommandRequest(command_id=uuid4(), command=commands.ChangeArea(search=NORTHWARD))
    first, again = [await stage.room.flights.command(mission_id, request, commands.Author("anna")) for _ in range(2)]
    assert again.accepted == first.accepted is True
    assert stage.journal.kinds(mission_id).count("area_changed") == 1


async def test_the_outlook_tells_what_the_bearings_say_there_and_changes_nothing(stage: Stage) -> None:
    mission_id = await held(stage)
    recorded = len(stage.journal.events(mission_id))
    found, vetoes = await stage.room.questions.outlook(mission_id, NORTHWARD)
    assert not vetoes
    assert found.belief.bearings >= 1
    assert (found.plan is None) == (found.no_plan is not None)
    _, vetoes = await stage.room.questions.outlook(mission_id, search(rectangle(1_000, 1_000, 1_300, 1_300)))
    assert isinstance(vetoes[0], OutsideFence)
    with pytest.raises(MissionInputError):
        await stage.room.questions.outlook(mission_id, search(Polygon(coordinates=[])))
    since = [fact.kind for fact in stage.journal.events(mission_id)[recorded:]]
    assert [kind for kind in since if not kind.startswith("alert_")] == []  # a starved machine may raise one


async def test_there_is_no_outlook_for_what_does_not_fly(stage: Stage) -> None:
    draft = await stage.room.drafts.create(spec(), "anna")
    with pytest.raises(MissionConflict) as refused:
        await stage.room.questions.outlook(draft, NORTHWARD)
    assert refused.value.reason == MissionDoesNotFly()
    with pytest.raises(MissionNotFound):
        await stage.room.questions.outlook("nobody", NORTHWARD)
    reply = await order(stage, draft, CHANGE)
    assert (reply.accepted, reply.reason) == (False, NotStarted())
