"""Whole missions on doubles of the ports: what is journaled, what reaches the vehicle, and when."""

from __future__ import annotations

import asyncio
import threading
from dataclasses import replace
from itertools import count
from unittest.mock import Mock
from uuid import uuid4

import pytest
from equipment import FRAME, HOME, SECOND_HZ, TWO_EMITTERS, spec
from flights import flying, order, stuck
from stage import Stage

from backend import commands
from backend.commands import CommandRequest
from backend.events import (
    FIRST_CRAFT,
    AuthorityChanged,
    BearingMeasured,
    BeliefUpdated,
    MissionDrafted,
    MissionEnded,
    MissionStarted,
    PhaseChanged,
    PlanChosen,
    SafetyVetoed,
    SweepStarted,
)
from backend.mission import flights
from backend.mission.runner import MissionRunner
from backend.mission.state import fold
from backend.reasons import Interrupted, NotLocalized, refusals
from backend.reasons.flight import Ordered
from backend.reasons.safety import OutsideFence
from hardware.readings import Telemetry


async def test_a_mission_is_flown_to_its_end_and_everything_is_kept(stage: Stage) -> None:
    mission_id = await flying(stage)
    await stage.until_true(lambda: stage.vehicle.names[-1:] == ["land"])
    stage.vehicle.touch_down()
    ended = await stage.until(mission_id, "mission_ended")
    assert isinstance(ended, MissionEnded)
    assert ended.outcome == "localized"
    beliefs = [e for e in stage.journal.events(mission_id) if isinstance(e, BeliefUpdated)]
    estimate = beliefs[-1].estimate
    assert estimate is not None
    east, north = FRAME.to_enu(replace(HOME, lat=estimate.lat, lon=estimate.lon))
    assert abs(east - 30.0) < 10
    assert abs(north - 60.0) < 10
    measured = [e.sweep_id for e in stage.journal.of_kind(mission_id, BearingMeasured)]
    assert [s for _, _, s in stage.journal.sweeps] == measured
    assert stage.vehicle.names[0] == "take_off"
    assert stage.vehicle.names[-1] == "land"
    assert "return_home" not in stage.vehicle.names
    assert stage.vehicle.names.count("turn") == len(measured)
    assert stage.journal.track
    assert stage.publisher.beliefs == [(b.emitter_id, b.bearings) for b in beliefs]
    assert stage.publisher.progress
    assert [r.seq for r in stage.publisher.shown] == list(range(1, len(stage.publisher.shown) + 1))


async def test_after_the_end_the_next_mission_may_start(stage: Stage) -> None:
    first = await flying(stage)
    second = await stage.room.drafts.create(spec(), "anna")
    refused = await order(stage, second, commands.Start())
    assert not refused.accepted
    assert isinstance(refused.reason, refusals.AnotherMissionFlies)
    await stage.until_phase(first, "landing")
    stage.vehicle.touch_down()
    await stage.until_mission(first, "done")
    await stage.until_true(lambda: stage.room.flights.active is None)
    assert (await order(stage, second, commands.Start())).accepted


async def test_after_a_pilot_landed_it_the_next_mission_may_start(stage: Stage) -> None:
    first = await stuck(stage)
    stage.vehicle.pilot_takes_over()
    await stage.until_phase(first, "manual")
    stage.vehicle.stuck = False
    stage.vehicle.touch_down()
    await stage.until_mission(first, "done")
    await stage.until_true(lambda: stage.room.flights.active is None)
    assert stage.vehicle.control.authority.taken_by == "mode"
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
    assert stage.journal.state(mission_id).phase == "aborted"
    await stage.until_true(lambda: stage.vehicle.names[-2:] == ["hold", "land"])


async def test_a_return_during_the_take_off_ends_the_mission_once_the_vehicle_is_down(stage: Stage) -> None:
    stage.vehicle.stuck = True
    mission_id = await flying(stage, "taking_off")
    await stage.until_true(lambda: stage.vehicle.names == ["take_off"])
    stage.vehicle.state = replace(stage.vehicle.state, armed=True, in_air=True)
    assert (await order(stage, mission_id, commands.Return())).accepted
    await stage.until_phase(mission_id, "landing")
    stage.vehicle.touch_down()
    ended = await stage.until(mission_id, "mission_ended")
    assert isinstance(ended, MissionEnded)
    assert isinstance(ended.reason, NotLocalized)
    assert ended.reason.because == Ordered("return", "anna")


async def test_a_return_before_the_vehicle_left_the_ground_ends_the_mission(stage: Stage) -> None:
    stage.vehicle.stuck = True
    mission_id = await flying(stage, "taking_off")
    assert (await order(stage, mission_id, commands.Return())).accepted
    await stage.until_mission(mission_id, "done")


async def test_a_restart_in_flight_is_hold_with_the_identical_belief_until_resumed(stage: Stage) -> None:
    mission_id = await flying(stage)
    await stage.until(mission_id, "belief_updated", 2)
    await stage.until(mission_id, "flight_started", 2)
    before = [e for e in stage.journal.events(mission_id) if isinstance(e, BeliefUpdated)][-1]
    await stage.room.shut_down()
    commands_before = len(stage.vehicle.commands)
    stage.room = stage.new_room()
    await stage.room.start_up()
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
    older = [await stage.room.drafts.create(spec(), "anna") for _ in range(2)]
    newest = await flying(stage)
    await stage.room.shut_down()
    started = stage.journal.of_kind(newest, MissionStarted)[0]
    begun = PhaseChanged(craft_id=FIRST_CRAFT, before="ground", after="flying", reason=Ordered("start", "anna"))
    for mission_id in older:
        await stage.journal.append(mission_id, [started, begun])
    stage.journal.stored = {mission_id: stage.journal.stored[mission_id] for mission_id in (*older, newest)}
    stage.room = stage.new_room()
    await stage.room.start_up()
    await stage.until_phase(newest, "hold")
    for mission_id in older:
        (ended,) = stage.journal.of_kind(mission_id, MissionEnded)
        assert (ended.outcome, ended.reason) == ("failed", Interrupted("later_mission"))
        assert stage.journal.state(mission_id).engaged == ()
        for refused in (commands.Resume(), commands.Hold()):
            assert not (await order(stage, mission_id, refused)).accepted
    assert await stage.journal.unfinished() == [newest]
    assert stage.active.mission_id == newest


async def test_a_mission_that_comes_back_is_held_before_its_ways_are_laid_out_and_watched_only_then(
    stage: Stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of thousands of corners of no-fly areas it takes seconds, on whichever thread asks first for the way home."""
    mission_id = await flying(stage)
    laid = threading.Event()
    monkeypatch.setattr(flights, "lay_out_ways", lambda _task: laid.wait(20.0))
    watched = Mock(side_effect=MissionRunner.begin)
    monkeypatch.setattr(MissionRunner, "begin", lambda runner: watched(runner))
    coming_back = asyncio.create_task(stage.restart())
    await stage.until_true(lambda: stage.vehicle.names[-1:] == ["hold"])
    assert not watched.called
    laid.set()
    await coming_back
    await stage.until_phase(mission_id, "hold")
    assert watched.called


async def test_a_mission_that_can_no_longer_be_read_is_closed_and_the_server_starts(stage: Stage) -> None:
    mission_id = await flying(stage)
    await stage.room.shut_down()
    nowhere = spec().model_copy(update={"area": spec().area.model_copy(update={"coordinates": []})})
    await stage.journal.append(mission_id, [MissionDrafted(spec=nowhere)])
    stage.room = stage.new_room()
    await stage.room.start_up()
    ended = await stage.until(mission_id, "mission_ended")
    assert isinstance(ended, MissionEnded)
    assert ended.reason == Interrupted("unreadable")
    assert stage.room.flights.active is None
    assert await stage.journal.unfinished() == []


async def test_after_an_abort_and_a_restart_the_vehicle_can_be_held_and_brought_home_until_it_is_down(
    stage: Stage,
) -> None:
    mission_id = await stuck(stage)
    assert (await order(stage, mission_id, commands.Abort())).accepted
    assert (await order(stage, mission_id, commands.Hold())).accepted
    assert stage.vehicle.names[-1] == "hold"
    await stage.restart()
    assert stage.active.mission_id == mission_id
    assert stage.journal.state(mission_id).phase == "aborted"
    await stage.until_phase(mission_id, "hold")
    sent = len(stage.vehicle.commands)
    assert (await order(stage, mission_id, commands.Hold())).accepted
    await stage.until_true(lambda: "hold" in stage.vehicle.names[sent:])
    refused = await order(stage, mission_id, commands.Resume())
    assert refused.reason == refusals.MissionOver()
    stage.vehicle.stuck = False
    assert (await order(stage, mission_id, commands.Return())).accepted
    await stage.until_true(lambda: stage.vehicle.names[-1] == "land")
    await stage.until_phase(mission_id, "landing")
    second = await stage.room.drafts.create(spec(), "anna")
    busy = await order(stage, second, commands.Start())
    assert isinstance(busy.reason, refusals.AnotherMissionFlies)
    stage.vehicle.touch_down()
    await stage.until_mission(mission_id, "aborted")
    await stage.until_true(lambda: stage.room.flights.active is None)
    assert stage.journal.kinds(mission_id).count("mission_ended") == 1
    assert await stage.journal.unfinished() == []


async def test_an_abort_right_before_the_server_went_away_is_brought_back_in_hold(stage: Stage) -> None:
    mission_id = await flying(stage)
    assert (await order(stage, mission_id, commands.Abort())).accepted
    assert await stage.journal.unfinished() == [mission_id]
    await stage.restart()
    assert stage.active.mission_id == mission_id
    await stage.until_phase(mission_id, "hold")


async def test_one_craft_finds_two_emitters_and_comes_home_when_both_are_localized() -> None:
    stage = Stage(target=(30.0, 60.0), others={SECOND_HZ: (-60.0, 30.0)})
    await stage.room.start_up()
    mission_id = await stage.room.drafts.create(spec(TWO_EMITTERS), "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted
    await stage.until_phase(mission_id, "landing")
    stage.vehicle.touch_down()
    await stage.until_mission(mission_id, "done")
    state = stage.journal.state(mission_id)
    assert state.search.outcome == "localized"
    turns = len(stage.journal.of_kind(mission_id, SweepStarted))
    assert stage.vehicle.names.count("turn") == turns
    for emitter in state.search.emitters.values():
        assert emitter.localized
        assert len(emitter.measured) == turns
        assert [m for m, emitter_id, _ in stage.journal.sweeps if emitter_id == emitter.emitter_id] == (
            [mission_id] * turns
        )
        assert (emitter.emitter_id, turns) in stage.publisher.beliefs
    await stage.room.shut_down()


async def test_who_flies_is_kept_and_survives_a_restart(stage: Stage) -> None:
    mission_id = await stuck(stage)
    assert [changed.authority.who for changed in stage.journal.of_kind(mission_id, AuthorityChanged)][-1] == "ours"
    stage.vehicle.pilot_takes_over()
    await stage.until_phase(mission_id, "manual")
    await stage.restart()
    await stage.until(mission_id, "server_restarted")
    assert stage.journal.state(mission_id).craft.phase == "manual"
    assert stage.journal.state(mission_id).craft.taken_over
    sent = len(stage.vehicle.commands)
    assert not (await order(stage, mission_id, commands.Hold())).accepted
    assert len(stage.vehicle.commands) == sent


async def test_a_command_id_is_answered_once_even_across_a_restart(stage: Stage) -> None:
    mission_id = await stuck(stage)
    request = CommandRequest(command_id=uuid4(), command=commands.Hold())
    first = await stage.room.flights.command(mission_id, request, commands.Author("anna"))
    again = await stage.room.flights.command(mission_id, request, commands.Author("anna"))
    assert (again.accepted, again.reason) == (first.accepted, first.reason)
    refused = CommandRequest(command_id=uuid4(), command=commands.Accept())
    no = await stage.room.flights.command(mission_id, refused, commands.Author("anna"))
    await stage.room.shut_down()
    stage.vehicle.stuck = False
    stage.room = stage.new_room()
    await stage.room.start_up()
    await stage.until(mission_id, "server_restarted")
    for asked, answered in ((request, first), (refused, no)):
        reply = await stage.room.flights.command(mission_id, asked, commands.Author("anna"))
        assert (reply.accepted, reply.reason) == (answered.accepted, answered.reason)
    assert stage.journal.kinds(mission_id).count("hold_ordered") == 1


async def test_a_start_sent_twice_at_once_starts_once(stage: Stage) -> None:
    mission_id = await stage.room.drafts.create(spec(), "anna")
    request = CommandRequest(command_id=uuid4(), command=commands.Start())
    replies = await asyncio.gather(
        *(stage.room.flights.command(mission_id, request, commands.Author("anna")) for _ in range(3))
    )
    assert all(reply.accepted for reply in replies)
    await stage.until(mission_id, "took_off")
    assert stage.journal.kinds(mission_id).count("mission_started") == 1


async def test_the_home_of_a_started_mission_is_the_one_its_task_was_made_for(
    stage: Stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    telemetry, asked = stage.vehicle.telemetry, count()

    def wandering() -> Telemetry:
        return replace(telemetry(), home=replace(HOME, lat=HOME.lat + 1e-7 * next(asked)))

    monkeypatch.setattr(stage.vehicle, "telemetry", wandering)
    mission_id = await stuck(stage)
    runner = stage.active
    home = runner.state.search.home
    assert home is not None
    assert (home.lat, home.lon) == (runner.task.frame.origin.lat, runner.task.frame.origin.lon)
    assert fold(stage.journal.stored[mission_id]).search.home == home


async def test_rejected_sweeps_are_taken_again_and_kept() -> None:
    stage = Stage(rejected=2)
    await stage.room.start_up()
    mission_id = await flying(stage)
    await stage.until(mission_id, "bearing_measured")
    kinds = stage.journal.kinds(mission_id)
    assert kinds.count("sweep_rejected") == 2
    assert kinds.count("sweep_started") >= 3
    assert len(stage.journal.sweeps) >= 3
    await stage.room.shut_down()


async def test_an_override_outside_the_fence_is_refused_and_one_inside_is_flown(stage: Stage) -> None:
    mission_id = await stuck(stage)
    far, near = FRAME.to_geo(1_000, 0), FRAME.to_geo(20, 30)
    refused = await order(stage, mission_id, commands.Override(place=far))
    assert not refused.accepted
    assert isinstance(refused.reason, OutsideFence)
    assert stage.journal.of_kind(mission_id, SafetyVetoed)[0].reason == refused.reason
    stage.vehicle.stuck = False
    place = near
    assert (await order(stage, mission_id, commands.Override(place=place))).accepted
    await stage.until(mission_id, "place_reached")
    chosen = [e for e in stage.journal.events(mission_id) if isinstance(e, PlanChosen)]
    assert chosen[1].source == "operator"
    assert chosen[1].by == "anna"


async def test_without_automatic_acceptance_the_place_waits(stage: Stage) -> None:
    mission_id = await flying(stage, "waiting", automatic=False)
    assert "goto" not in stage.vehicle.names
    assert (await order(stage, mission_id, commands.Veto())).accepted
    await stage.until(mission_id, "plan_chosen", 2)
    places = [e.place for e in stage.journal.events(mission_id) if isinstance(e, PlanChosen)]
    assert places[0] != places[1]
    await stage.until_phase(mission_id, "waiting")
    assert (await order(stage, mission_id, commands.Accept())).accepted
    await stage.until(mission_id, "bearing_measured")
