"""The autopilot's own nets: noted before they change, up before the take-off, put back whatever happens between."""

from __future__ import annotations

import pytest
from equipment import spec
from flights import flying, order, stuck
from stage import Stage

from backend import commands
from backend.events import FIRST_CRAFT, NetsNoted, NetsPutBack
from backend.mission.nets import NetsKeeper
from backend.mission.records import Records
from backend.spec import SearchArea
from hardware.fence import FencePolygon, Nets, ParameterValue
from hardware.reasons.nets import FenceReadBackDifferent

OWN = Nets((), (ParameterValue("CEILING", 0.0),))


@pytest.fixture(autouse=True)
def often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("backend.mission.nets.LOOK_S", 0.05)


async def drafted(stage: Stage) -> str:
    return await stage.room.drafts.create(spec(), "anna")


async def test_a_look_at_the_checklist_sets_nothing(stage: Stage) -> None:
    mission_id = await drafted(stage)
    checked = await stage.room.drafts.preflight(mission_id)
    assert [check.ok for check in checked.checks if check.name == "nets"] == [True]
    assert stage.vehicle.nets_set == []
    assert stage.journal.of_kind(mission_id, NetsNoted) == []


async def test_the_start_sets_the_nets_after_the_owners_are_durable_and_before_anything_flies(stage: Stage) -> None:
    mission_id = await flying(stage)
    (noted,) = stage.journal.of_kind(mission_id, NetsNoted)
    assert noted.before == OWN
    assert noted.after == stage.vehicle.nets
    assert any(isinstance(zone, FencePolygon) and zone.inside for zone in noted.after.zones)
    kinds = stage.journal.kinds(mission_id)
    assert kinds.index("nets_noted") < kinds.index("mission_started")


async def test_after_the_landing_the_owners_nets_are_back(stage: Stage) -> None:
    mission_id = await flying(stage)
    await stage.until_phase(mission_id, "landing")
    assert stage.vehicle.nets != OWN
    stage.vehicle.touch_down()
    await stage.until(mission_id, "nets_put_back")
    assert stage.vehicle.nets == OWN
    assert stage.journal.of_kind(mission_id, NetsPutBack) == [NetsPutBack(craft_id=FIRST_CRAFT, whole=True)]


async def test_nets_that_are_not_taken_refuse_the_start_and_leave_nothing_behind(stage: Stage) -> None:
    stage.vehicle.nets_refused = FenceReadBackDifferent(3)
    mission_id = await drafted(stage)
    reply = await order(stage, mission_id, commands.Start())
    assert (reply.accepted, reply.reason) == (False, FenceReadBackDifferent(3))
    assert stage.vehicle.names == []
    stage.vehicle.nets_refused = None
    await stage.until(mission_id, "nets_put_back")
    assert (await order(stage, mission_id, commands.Start())).accepted


async def test_a_server_killed_between_noting_and_take_off_puts_back_when_it_is_there_again(stage: Stage) -> None:
    mission_id = await drafted(stage)
    ours = Nets((), (ParameterValue("CEILING", 123.0),))
    await stage.journal.append(mission_id, [NetsNoted(craft_id=FIRST_CRAFT, before=OWN, after=ours)])
    stage.vehicle.nets = ours
    await stage.restart()
    await stage.until(mission_id, "nets_put_back")
    assert stage.vehicle.nets == OWN


async def test_a_server_that_restarts_in_flight_keeps_the_nets_up(stage: Stage) -> None:
    mission_id = await stuck(stage)
    up = stage.vehicle.nets
    stage.vehicle.stuck = False
    await stage.restart()
    await stage.until_phase(mission_id, "hold")
    await stage.clock.sleep(20.0)
    assert stage.vehicle.nets == up
    assert stage.journal.of_kind(mission_id, NetsPutBack) == []


async def test_what_somebody_changed_since_is_left_as_they_have_it(stage: Stage) -> None:
    mission_id = await flying(stage)
    await stage.until_phase(mission_id, "landing")
    theirs = Nets((), (ParameterValue("CEILING", 55.0),))
    stage.vehicle.nets = theirs
    stage.vehicle.touch_down()
    await stage.until(mission_id, "nets_put_back")
    assert stage.vehicle.nets == theirs
    assert not stage.journal.of_kind(mission_id, NetsPutBack)[0].whole


async def test_what_is_owed_is_settled_before_the_next_mission_notes_the_owners(stage: Stage) -> None:
    mission_id = await drafted(stage)
    keeper = NetsKeeper(stage.room.equipment, Records(stage.journal, stage.publisher, stage.clock))
    ours = Nets((), (ParameterValue("CEILING", 123.0),))
    await stage.journal.append(mission_id, [NetsNoted(craft_id=FIRST_CRAFT, before=OWN, after=ours)])
    stage.vehicle.nets = ours
    await keeper.recall()
    assert set(keeper.owed) == {FIRST_CRAFT}
    stage.vehicle.heard = False
    await keeper.settle()
    assert stage.vehicle.nets == ours  # not while it is not heard
    stage.vehicle.heard = True
    await keeper.settle()
    assert stage.vehicle.nets == OWN
    assert keeper.owed == {}


async def test_in_flight_the_nets_follow_the_search_area_and_the_owners_are_put_back_all_the_same(stage: Stage) -> None:
    mission_id = await stuck(stage)
    await order(stage, mission_id, commands.Hold())
    await stage.until_phase(mission_id, "hold")
    before = stage.vehicle.nets
    search = spec(fence_margin_m=90.0)
    wider = SearchArea(area=search.area, priors={}, fence=None, fence_margin_m=90.0, no_fly=[])
    assert (await order(stage, mission_id, commands.ChangeArea(search=wider))).accepted
    first, second = stage.journal.of_kind(mission_id, NetsNoted)
    assert (first.before, second.before) == (OWN, OWN)
    assert first.after == before
    assert second.after == stage.vehicle.nets != before
    stage.vehicle.stuck = False
    stage.vehicle.touch_down()
    await order(stage, mission_id, commands.Abort())
    await stage.until(mission_id, "nets_put_back")
    assert stage.vehicle.nets == OWN
