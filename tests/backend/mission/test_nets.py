"""The autopilot's own nets: noted before they change, up before the take-off, put back whatever happens between."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import replace
from uuid import uuid4

import pytest
from equipment import spec
from flights import flying, order, stuck
from stage import Stage

from backend import commands
from backend.commands import CommandRequest
from backend.events import FIRST_CRAFT, AreaChanged, NetsNoted, NetsPutBack
from backend.mission.nets import NetsKeeper
from backend.mission.records import Records
from backend.reasons.refusals import NetsChanging
from backend.spec import FIRST_EMITTER, GaussianPriorSpec, Place, PriorSpec, SearchArea
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


async def test_nets_that_were_owed_as_somebody_armed_it_stay_owed_until_it_stands_again(
    stage: Stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    mission_id = await flying(stage)
    await stage.until_phase(mission_id, "landing")
    up, began, at_once = stage.vehicle.nets, asyncio.Event(), stage.vehicle.put_nets_back

    async def armed_meanwhile(before: Nets, ours: Sequence[Nets]) -> bool | None:
        if not began.is_set():
            began.set()
            stage.vehicle.state = replace(stage.vehicle.state, armed=True)
        return await at_once(before, ours)

    monkeypatch.setattr(stage.vehicle, "put_nets_back", armed_meanwhile)
    stage.vehicle.touch_down()
    await began.wait()
    await asyncio.sleep(0.2)
    assert stage.vehicle.nets == up
    assert stage.journal.of_kind(mission_id, NetsPutBack) == []
    stage.vehicle.touch_down()
    await stage.until(mission_id, "nets_put_back")
    assert stage.vehicle.nets == OWN


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


def elsewhere(margin_m: float, prior: PriorSpec | None = None) -> commands.ChangeArea:
    priors = {} if prior is None else {FIRST_EMITTER: prior}
    search = SearchArea(area=spec().area, priors=priors, fence=None, fence_margin_m=margin_m, no_fly=[])
    return commands.ChangeArea(search=search)


def slow_link(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> asyncio.Event:
    """No net is set before the event is."""
    done, at_once = asyncio.Event(), stage.vehicle.set_nets

    async def slowly(nets: Nets) -> None:
        await done.wait()
        await at_once(nets)

    monkeypatch.setattr(stage.vehicle, "set_nets", slowly)
    return done


async def held(stage: Stage) -> str:
    mission_id = await stuck(stage)
    await order(stage, mission_id, commands.Hold())
    await stage.until_phase(mission_id, "hold")
    return mission_id


async def test_nothing_flies_on_before_the_nets_of_the_new_area_hang(stage: Stage, monkeypatch) -> None:
    """A fence of sixteen corners takes 45 s over a link of 250 ms, and beyond the old one the autopilot turns back."""
    mission_id = await held(stage)
    done = slow_link(stage, monkeypatch)
    changing = asyncio.ensure_future(order(stage, mission_id, elsewhere(90.0)))
    await stage.until(mission_id, "nets_noted", 2)
    for command in (commands.Resume(), commands.Override(place=Place(lat=50.0003, lon=7.0))):
        reply = await order(stage, mission_id, command)
        assert (reply.accepted, reply.reason) == (False, NetsChanging())
    assert (await order(stage, mission_id, commands.Hold())).accepted
    done.set()
    assert (await changing).accepted
    stage.vehicle.stuck = False
    assert (await order(stage, mission_id, commands.Resume())).accepted


async def test_a_server_killed_while_the_nets_change_hangs_them_when_it_is_back(stage: Stage, monkeypatch) -> None:
    mission_id = await held(stage)
    before = stage.vehicle.nets
    slow_link(stage, monkeypatch)
    changing = asyncio.ensure_future(order(stage, mission_id, elsewhere(90.0)))
    await stage.until(mission_id, "nets_noted", 2)
    changing.cancel()
    monkeypatch.undo()
    monkeypatch.setattr("backend.mission.elsewhere.AGAIN_S", 0.05)
    stage.vehicle.nets_refused = FenceReadBackDifferent(3)
    await stage.restart()
    await stage.until(mission_id, "server_restarted")
    await stage.until_true(lambda: stage.active.state.craft.open_alerts != ())
    assert [raised.reason for raised in stage.active.state.craft.open_alerts] == [FenceReadBackDifferent(3)]
    assert stage.vehicle.nets == before
    reply = await order(stage, mission_id, commands.Resume())
    assert (reply.accepted, reply.reason) == (False, NetsChanging())
    assert stage.room.display.status().crafts[0].resume_refused == NetsChanging(), "the page says it"
    stage.vehicle.nets_refused = None
    await stage.until(mission_id, "nets_hung")
    assert stage.vehicle.nets == stage.journal.of_kind(mission_id, NetsNoted)[-1].after != before
    assert all(noted.before == OWN for noted in stage.journal.of_kind(mission_id, NetsNoted))
    assert stage.active.state.craft.open_alerts == ()
    stage.vehicle.stuck = False
    assert (await order(stage, mission_id, commands.Resume())).accepted


async def test_no_net_is_hung_around_a_pilot_and_one_who_gives_back_is_resumed_after_it(
    stage: Stage, monkeypatch
) -> None:
    mission_id = await held(stage)
    monkeypatch.setattr("backend.mission.elsewhere.AGAIN_S", 0.05)
    stage.vehicle.nets_refused = FenceReadBackDifferent(3)
    await stage.restart()
    assert (await order(stage, mission_id, elsewhere(90.0))).accepted
    before = stage.vehicle.nets
    stage.vehicle.pilot_takes_over()
    await stage.until_phase(mission_id, "manual")
    stage.vehicle.nets_refused = None
    await asyncio.sleep(0.5)
    assert stage.vehicle.nets == before
    stage.vehicle.pilot_gives_back()
    await stage.until(mission_id, "nets_hung")
    stage.vehicle.stuck = False
    assert (await order(stage, mission_id, commands.Resume())).accepted


async def test_a_change_that_a_landing_overtakes_leaves_the_owners_nets(stage: Stage, monkeypatch) -> None:
    """The change still speaks to the autopilot when the craft is down."""
    mission_id = await held(stage)
    done = slow_link(stage, monkeypatch)
    changing = asyncio.ensure_future(order(stage, mission_id, elsewhere(90.0)))
    await stage.until(mission_id, "nets_noted", 2)
    stage.vehicle.stuck = False
    await order(stage, mission_id, commands.Land())
    await stage.until_phase(mission_id, "landing")
    stage.vehicle.touch_down()
    await stage.until_true(lambda: not stage.journal.state(mission_id).engaged)
    await asyncio.sleep(0.2)
    done.set()
    await changing
    await stage.until(mission_id, "nets_put_back")
    await asyncio.sleep(0.2)
    assert stage.vehicle.nets == OWN


async def test_of_two_changes_at_once_the_nets_are_those_of_the_area_that_is_searched(
    stage: Stage, monkeypatch
) -> None:
    """From two tabs: the second knows nothing of what the first says of the emitter."""
    mission_id = await held(stage)
    done = slow_link(stage, monkeypatch)
    prior = GaussianPriorSpec(
        centre=Place(lat=50.0004, lon=7.0), sigma_major_m=40.0, sigma_minor_m=40.0, major_axis_deg=0.0
    )
    both = [
        asyncio.ensure_future(order(stage, mission_id, elsewhere(75.0, prior))),
        asyncio.ensure_future(order(stage, mission_id, elsewhere(90.0))),
    ]
    await stage.until(mission_id, "nets_noted", 2)
    done.set()
    assert [reply.accepted for reply in await asyncio.gather(*both)] == [True, True]
    first, second = stage.journal.of_kind(mission_id, AreaChanged)
    assert {first.search.fence_margin_m, second.search.fence_margin_m} == {75.0, 90.0}
    assert stage.active.task.mission == stage.journal.state(mission_id).search.mission
    noted = stage.journal.of_kind(mission_id, NetsNoted)
    assert len(noted) == 3
    assert stage.vehicle.nets == noted[-1].after


async def test_an_order_that_is_sent_again_hangs_no_nets_of_an_area_of_before(stage: Stage) -> None:
    mission_id = await held(stage)
    first = CommandRequest(command_id=uuid4(), command=elsewhere(60.0))
    author = commands.Author("anna")
    assert (await stage.room.flights.command(mission_id, first, author)).accepted
    assert (await order(stage, mission_id, elsewhere(90.0))).accepted
    hanging = stage.vehicle.nets
    assert (await stage.room.flights.command(mission_id, first, author)).accepted, "it was"
    assert stage.vehicle.nets == hanging


async def test_nets_that_are_never_taken_are_noted_once_and_leave_a_way_home_after_a_pilot(
    stage: Stage, monkeypatch
) -> None:
    mission_id = await held(stage)
    monkeypatch.setattr("backend.mission.elsewhere.AGAIN_S", 0.02)
    tries, at_once = [], stage.vehicle.set_nets

    async def counted(nets: Nets) -> None:
        tries.append(nets)
        await at_once(nets)

    monkeypatch.setattr(stage.vehicle, "set_nets", counted)
    stage.vehicle.nets_refused = FenceReadBackDifferent(3)
    await stage.restart()
    assert (await order(stage, mission_id, elsewhere(90.0))).accepted
    await stage.until_true(lambda: len(tries) > 5)
    assert len(stage.journal.of_kind(mission_id, NetsNoted)) == 2
    stage.vehicle.pilot_takes_over()
    await stage.until_phase(mission_id, "manual")
    stage.vehicle.pilot_gives_back()
    stage.vehicle.stuck = False
    for command in (commands.Resume(), commands.Return()):
        assert (await order(stage, mission_id, command)).accepted
    await stage.until_phase(mission_id, "landing")
