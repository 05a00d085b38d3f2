"""Whole missions through the service on doubles of the ports: what is journaled, what reaches the vehicle, and when."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from itertools import count
from uuid import uuid4

import pytest
from doubles import FRAME, HOME, Stage, spec
from flights import flying, order, stuck

from backend import commands
from backend.commands import CommandRequest
from backend.events import BeliefUpdated, MissionDrafted, MissionEnded, PhaseChanged, PlanChosen, SafetyVetoed
from backend.mission.errors import MissionConflict, MissionInputError, MissionNotFound
from backend.mission.state import fold
from backend.spec import Place
from hardware.readings import Telemetry


async def test_a_mission_is_flown_to_its_end_and_everything_is_kept(stage: Stage) -> None:
    mission_id = await flying(stage)
    await stage.until_phase(mission_id, "landing")
    stage.vehicle.touch_down()
    ended = await stage.until(mission_id, "mission_ended")
    assert isinstance(ended, MissionEnded)
    assert ended.outcome == "localized"
    beliefs = [e for e in stage.journal.events(mission_id) if isinstance(e, BeliefUpdated)]
    estimate = beliefs[-1].estimate
    assert estimate is not None
    east, north = FRAME.to_enu(replace(HOME, lat_deg=estimate.lat, lon_deg=estimate.lon))
    assert abs(east - 30.0) < 10
    assert abs(north - 60.0) < 10
    measured = [e.sweep_id for e in stage.journal.events(mission_id) if e.kind == "bearing_measured"]  # type: ignore[union-attr]
    assert [s for _, s in stage.journal.sweeps] == measured
    assert stage.vehicle.names[0] == "take_off"
    assert stage.vehicle.names[-1] == "return_home"
    assert stage.vehicle.names.count("turn") == len(measured)
    assert stage.journal.track
    assert stage.publisher.beliefs == [b.bearings for b in beliefs]
    assert stage.publisher.progress
    assert [r.seq for r in stage.publisher.shown] == list(range(1, len(stage.publisher.shown) + 1))


async def test_after_the_end_the_next_mission_may_start(stage: Stage) -> None:
    first = await flying(stage)
    second = await stage.service.create(spec(), "anna")
    refused = await order(stage, second, commands.Start())
    assert not refused.accepted
    assert "another mission is still flying" in refused.reason
    await stage.until_phase(first, "landing")
    stage.vehicle.touch_down()
    await stage.until_phase(first, "done")
    await stage.until_true(lambda: stage.service.active_mission_id is None)
    stage.vehicle.state = replace(stage.vehicle.state, controller="nobody")
    assert (await order(stage, second, commands.Start())).accepted


async def test_after_a_pilot_landed_it_the_next_mission_may_start(stage: Stage) -> None:
    first = await stuck(stage)
    stage.vehicle.take_control()
    await stage.until_phase(first, "manual")
    stage.vehicle.stuck = False
    stage.vehicle.touch_down()
    await stage.until_phase(first, "done")
    await stage.until_true(lambda: stage.service.active_mission_id is None)
    assert stage.vehicle.state.controller == "pilot"
    await flying(stage)


async def test_hold_reaches_the_vehicle_before_the_journal_is_waited_for(stage: Stage) -> None:
    mission_id = await stuck(stage)
    stage.journal.away = True
    reply = asyncio.create_task(order(stage, mission_id, commands.Hold()))
    await stage.until_true(lambda: "hold" in stage.vehicle.names)
    assert not reply.done()
    stage.journal.away = False
    assert (await reply).accepted
    assert stage.journal.kinds(mission_id).count("hold_ordered") == 1


async def test_abort_holds_and_returns_at_once(stage: Stage) -> None:
    mission_id = await stuck(stage)
    stage.vehicle.stuck = False
    assert (await order(stage, mission_id, commands.Abort())).accepted
    await stage.until_phase(mission_id, "aborted")
    await stage.until_true(lambda: stage.vehicle.names[-2:] == ["hold", "return_home"])


async def test_a_return_during_the_take_off_ends_the_mission_once_the_vehicle_is_down(stage: Stage) -> None:
    stage.vehicle.stuck = True
    mission_id = await flying(stage, "taking_off")
    await stage.until_true(lambda: stage.vehicle.names == ["take_off"])
    stage.vehicle.state = replace(stage.vehicle.state, armed=True, in_air=True)
    assert (await order(stage, mission_id, commands.Return())).accepted
    await stage.until_phase(mission_id, "landing")
    stage.vehicle.touch_down()
    ended = await stage.until(mission_id, "mission_ended")
    assert ended.reason.startswith("return ordered by anna")  # type: ignore[union-attr]


async def test_a_return_before_the_vehicle_left_the_ground_ends_the_mission(stage: Stage) -> None:
    stage.vehicle.stuck = True
    mission_id = await flying(stage, "taking_off")
    assert (await order(stage, mission_id, commands.Return())).accepted
    await stage.until_phase(mission_id, "done")


async def test_a_restart_in_flight_is_hold_with_the_identical_belief_until_resumed(stage: Stage) -> None:
    mission_id = await flying(stage)
    await stage.until(mission_id, "belief_updated", 2)
    await stage.until(mission_id, "flight_started", 2)
    before = [e for e in stage.journal.events(mission_id) if isinstance(e, BeliefUpdated)][-1]
    await stage.service.shut_down()
    commands_before = len(stage.vehicle.commands)
    stage.service = stage.new_service()
    await stage.service.start_up()
    await stage.until_phase(mission_id, "hold")
    count = stage.journal.kinds(mission_id).count("belief_updated")
    again = await stage.until(mission_id, "belief_updated", max(count, 3))
    assert isinstance(again, BeliefUpdated)
    assert again.digest == before.digest
    await stage.clock.sleep(10)
    assert stage.vehicle.names[commands_before:] in (["hold"], [])
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until_phase(mission_id, "landing")
    stage.vehicle.touch_down()
    ended = await stage.until(mission_id, "mission_ended")
    assert ended.outcome == "localized"  # type: ignore[union-attr]


async def test_of_several_unfinished_missions_the_last_comes_back_and_the_others_are_closed_as_interrupted(
    stage: Stage,
) -> None:
    older = [await stage.service.create(spec(), "anna") for _ in range(2)]
    newest = await flying(stage)
    await stage.service.shut_down()
    started = next(e for e in stage.journal.events(newest) if e.kind == "mission_started")
    for mission_id in older:
        await stage.journal.append(mission_id, [started, PhaseChanged(before="draft", after="flying", reason="")])
    stage.journal.stored = {mission_id: stage.journal.stored[mission_id] for mission_id in (*older, newest)}
    stage.service = stage.new_service()
    await stage.service.start_up()
    await stage.until_phase(newest, "hold")
    for mission_id in older:
        ended = stage.journal.events(mission_id)[-2]
        assert isinstance(ended, MissionEnded)
        assert (ended.outcome, ended.reason.split(":")[0]) == ("failed", "interrupted")
        assert "started later" in ended.reason
        assert not (await order(stage, mission_id, commands.Resume())).accepted
    assert await stage.journal.unfinished() == [newest]
    assert stage.service.active_mission_id == newest


async def test_a_mission_that_can_no_longer_be_read_is_closed_and_the_server_starts(stage: Stage) -> None:
    mission_id = await flying(stage)
    await stage.service.shut_down()
    nowhere = spec().model_copy(update={"area": spec().area.model_copy(update={"coordinates": []})})
    await stage.journal.append(mission_id, [MissionDrafted(spec=nowhere)])
    stage.service = stage.new_service()
    await stage.service.start_up()
    ended = await stage.until(mission_id, "mission_ended")
    assert "can no longer be read" in ended.reason  # type: ignore[union-attr]
    assert stage.service.active_mission_id is None


async def test_a_command_id_is_answered_once_even_across_a_restart(stage: Stage) -> None:
    mission_id = await stuck(stage)
    request = CommandRequest(command_id=uuid4(), command=commands.Hold())
    first = await stage.service.command(mission_id, request, "anna")
    again = await stage.service.command(mission_id, request, "anna")
    assert first == again
    refused = CommandRequest(command_id=uuid4(), command=commands.Accept())
    no = await stage.service.command(mission_id, refused, "anna")
    await stage.service.shut_down()
    stage.vehicle.stuck = False
    stage.service = stage.new_service()
    await stage.service.start_up()
    await stage.until(mission_id, "server_restarted")
    for asked, answered in ((request, first), (refused, no)):
        reply = await stage.service.command(mission_id, asked, "anna")
        assert (reply.accepted, reply.reason, reply.remedy) == (answered.accepted, answered.reason, answered.remedy)
    assert stage.journal.kinds(mission_id).count("hold_ordered") == 1


async def test_a_start_sent_twice_at_once_starts_once(stage: Stage) -> None:
    mission_id = await stage.service.create(spec(), "anna")
    request = CommandRequest(command_id=uuid4(), command=commands.Start())
    replies = await asyncio.gather(*(stage.service.command(mission_id, request, "anna") for _ in range(3)))
    assert all(reply.accepted for reply in replies)
    await stage.until(mission_id, "took_off")
    assert stage.journal.kinds(mission_id).count("mission_started") == 1


async def test_the_home_of_a_started_mission_is_the_one_its_task_was_made_for(
    stage: Stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    telemetry, asked = stage.vehicle.telemetry, count()

    def wandering() -> Telemetry:
        return replace(telemetry(), home=replace(HOME, lat_deg=HOME.lat_deg + 1e-7 * next(asked)))

    monkeypatch.setattr(stage.vehicle, "telemetry", wandering)
    mission_id = await stuck(stage)
    runner = stage.service._runner
    assert runner is not None
    home = runner.state.home
    assert home is not None
    assert (home.lat, home.lon) == (runner.task.frame.origin.lat_deg, runner.task.frame.origin.lon_deg)
    assert fold(stage.journal.stored[mission_id]).home == home


async def test_rejected_sweeps_are_taken_again_and_kept() -> None:
    stage = Stage(rejected=2)
    await stage.service.start_up()
    mission_id = await flying(stage)
    await stage.until(mission_id, "bearing_measured")
    kinds = stage.journal.kinds(mission_id)
    assert kinds.count("sweep_rejected") == 2
    assert kinds.count("sweep_started") >= 3
    assert len(stage.journal.sweeps) >= 3
    await stage.service.shut_down()


async def test_an_override_outside_the_fence_is_refused_and_one_inside_is_flown(stage: Stage) -> None:
    mission_id = await stuck(stage)
    far, near = FRAME.to_geo(1_000, 0), FRAME.to_geo(20, 30)
    refused = await order(stage, mission_id, commands.Override(place=Place(lat=far.lat_deg, lon=far.lon_deg)))
    assert not refused.accepted
    assert "outside the fence" in refused.reason
    assert any(isinstance(e, SafetyVetoed) and e.rule == "fence" for e in stage.journal.events(mission_id))
    stage.vehicle.stuck = False
    place = Place(lat=near.lat_deg, lon=near.lon_deg)
    assert (await order(stage, mission_id, commands.Override(place=place))).accepted
    await stage.until(mission_id, "place_reached")
    chosen = [e for e in stage.journal.events(mission_id) if isinstance(e, PlanChosen)]
    assert chosen[1].source == "operator"
    assert chosen[1].by == "anna"


async def test_without_automatic_acceptance_the_place_waits(stage: Stage) -> None:
    mission_id = await flying(stage, "waiting", automatic=False)
    assert "goto" not in stage.vehicle.names
    assert stage.service.status().waits_for is not None
    assert (await order(stage, mission_id, commands.Veto())).accepted
    await stage.until(mission_id, "plan_chosen", 2)
    places = [e.place for e in stage.journal.events(mission_id) if isinstance(e, PlanChosen)]
    assert places[0] != places[1]
    await stage.until_phase(mission_id, "waiting")
    assert (await order(stage, mission_id, commands.Accept())).accepted
    await stage.until(mission_id, "bearing_measured")


async def test_drafts_are_checked_edited_and_refused_with_reasons(stage: Stage) -> None:
    bad = spec().model_copy(update={"area": spec().area.model_copy(update={"coordinates": []})})
    with pytest.raises(MissionInputError):
        await stage.service.create(bad, "anna")
    mission_id = await stage.service.create(spec(), "anna")
    assert (await stage.service.preflight(mission_id)).passed
    await stage.service.edit(mission_id, spec(speed_m_s=5.0), "anna")
    assert stage.journal.kinds(mission_id)[-2:] == ["mission_edited", "phase_changed"]
    assert not (await order(stage, mission_id, commands.Hold())).accepted
    with pytest.raises(MissionNotFound):
        await stage.service.edit("nobody", spec(), "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted
    with pytest.raises(MissionConflict):
        await stage.service.edit(mission_id, spec(), "anna")


async def test_a_forecast_and_a_preview_say_how_long_it_may_take(stage: Stage) -> None:
    seen = await stage.service.preview(spec())
    assert seen.first_place
    mission_id = await stage.service.create(spec(), "anna")
    near, far = FRAME.to_geo(0, -20), FRAME.to_geo(0, -900)
    allowed = await stage.service.expected_time(mission_id, Place(lat=near.lat_deg, lon=near.lon_deg))
    assert allowed.allowed
    assert allowed.mean_s is not None
    assert allowed.p90_s is not None
    assert allowed.p90_s >= allowed.mean_s
    refused = await stage.service.expected_time(mission_id, Place(lat=far.lat_deg, lon=far.lon_deg))
    assert not refused.allowed
    assert refused.reason


async def test_telemetry_and_status_are_shown_without_a_mission(stage: Stage) -> None:
    await asyncio.sleep(0.3)
    assert stage.publisher.telemetries >= 2
    assert stage.publisher.statuses[0].mission_id is None
