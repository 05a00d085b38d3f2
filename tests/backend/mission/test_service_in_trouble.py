"""Missions through the service when a link, the battery, the receiver, the database or a pilot comes between."""

from __future__ import annotations

import asyncio
from dataclasses import replace

import pytest
from doubles import Stage, spec
from flights import flying, order, stuck

from backend import commands
from backend.commands import Command
from backend.events import LinkLost, PhaseChanged
from backend.mission import inputs, watch
from backend.mission.state import fold
from backend.spec import Place, TimerSpec


async def test_a_vehicle_that_landed_at_home_while_it_was_not_heard_ends_the_mission(stage: Stage) -> None:
    mission_id = await stuck(stage)
    stage.vehicle.stuck = False
    assert (await order(stage, mission_id, commands.Return())).accepted
    await stage.until_phase(mission_id, "landing")
    stage.vehicle.heard = False
    await stage.until(mission_id, "link_lost")
    stage.vehicle.touch_down()
    stage.vehicle.heard = True
    await stage.until_phase(mission_id, "done")
    assert "land" not in stage.vehicle.names
    told = [e.text for e in stage.journal.events(mission_id) if e.kind == "alert_raised"]  # type: ignore[union-attr]
    assert not any("landed" in text for text in told)


async def test_the_pilot_silences_the_mission_until_an_operator_resumes(stage: Stage) -> None:
    mission_id = await stuck(stage)
    stage.vehicle.take_control()
    await stage.until(mission_id, "control_taken")
    sent = list(stage.vehicle.commands)
    for command in (commands.Hold(), commands.Return(), commands.Override(place=Place(lat=50.0003, lon=7.0))):
        assert not (await order(stage, mission_id, command)).accepted
    await stage.clock.sleep(10)
    stage.vehicle.stuck = False
    refused = await order(stage, mission_id, commands.Resume())
    assert not refused.accepted
    assert "POSCTL" in refused.reason
    assert stage.vehicle.commands == sent
    assert stage.vehicle.state.controller == "pilot"
    stage.vehicle.give_back()
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until(mission_id, "place_reached")
    assert len(stage.vehicle.commands) > len(sent)


async def test_a_receiver_that_falls_silent_while_measuring_holds_and_resume_goes_on(stage: Stage) -> None:
    mission_id = await flying(stage, "measuring")
    stage.receiver.mute = True
    await stage.until_phase(mission_id, "hold")
    lost = await stage.until(mission_id, "link_lost")
    assert isinstance(lost, LinkLost)
    assert lost.link == "receiver"
    stage.receiver.mute = False
    await stage.until(mission_id, "link_restored")
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until(mission_id, "bearing_measured")


async def test_a_vehicle_that_is_gone_holds_with_an_alert_and_comes_back(stage: Stage) -> None:
    mission_id = await stuck(stage)
    stage.vehicle.heard = False
    await stage.until_phase(mission_id, "hold")
    assert not (await order(stage, mission_id, commands.Resume())).accepted
    stage.vehicle.heard = True
    stage.vehicle.stuck = False
    await stage.until(mission_id, "link_restored")
    assert stage.vehicle.names[-1] == "hold"
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until(mission_id, "bearing_measured")


async def failsafe_flying(stage: Stage) -> str:
    """The autopilot began its own return while it was not heard."""
    mission_id = await stuck(stage)
    stage.vehicle.heard = False
    await stage.until_phase(mission_id, "hold")
    stage.vehicle.stuck = False
    stage.vehicle.state = replace(stage.vehicle.state, controller="pilot", mode="RETURN", held_by_pilot=True)
    stage.vehicle.heard = True
    await stage.until(mission_id, "link_restored")
    return mission_id


@pytest.mark.parametrize(
    ("command", "sent"),
    [(commands.Hold(), ["hold"]), (commands.Return(), ["return_home"]), (commands.Abort(), ["hold", "return_home"])],
)
async def test_an_operator_may_take_the_vehicle_from_its_failsafe_which_is_no_pilot(
    stage: Stage, command: Command, sent: list[str]
) -> None:
    mission_id = await failsafe_flying(stage)
    assert "on its own way home" in stage.journal.events(mission_id)[-1].text  # type: ignore[union-attr]
    assert (await order(stage, mission_id, command)).accepted
    await stage.until_true(lambda: stage.vehicle.names[-len(sent) :] == sent)
    await stage.until_true(lambda: fold(stage.journal.stored[mission_id]).open_alerts == ())
    assert not {"control_taken", "control_released"} & set(stage.journal.kinds(mission_id))


async def test_a_place_chosen_while_the_failsafe_flies_is_refused_with_its_name(stage: Stage) -> None:
    mission_id = await failsafe_flying(stage)
    refused = await order(stage, mission_id, commands.Override(place=Place(lat=50.0003, lon=7.0)))
    assert (refused.accepted, refused.reason, refused.remedy) == (
        False,
        "the autopilot acts by itself: RETURN",
        "hold or resume first",
    )


async def test_a_step_that_finds_the_failsafe_flying_right_after_a_resume_is_not_told_as_a_pilot(
    stage: Stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(watch, "HEARD_AGAIN_WALL_S", 60.0)
    mission_id = await stuck(stage)
    stage.vehicle.heard = False
    await stage.until_phase(mission_id, "hold")
    stage.vehicle.heard = True
    await stage.until(mission_id, "link_restored")
    goto = stage.vehicle.goto

    async def failsafe_first(*place: object) -> None:
        stage.vehicle.state = replace(stage.vehicle.state, controller="pilot", mode="RETURN", held_by_pilot=True)
        await goto(*place)  # type: ignore[arg-type]

    stage.vehicle.goto = failsafe_first  # type: ignore[method-assign]
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until_true(lambda: stage.service.status().phase == "hold")
    await stage.until_phase(mission_id, "hold")
    assert "control_taken" not in stage.journal.kinds(mission_id)


async def test_without_a_console_the_failsafes_own_return_is_left_to_bring_the_vehicle_home() -> None:
    stage = Stage()
    await stage.service.start_up()
    mission_id = await failsafe_flying(stage)
    runner = stage.service._runner
    assert runner is not None
    sent = list(stage.vehicle.commands)
    runner.give(inputs.TimerExpired("console_return"))
    await stage.until_phase(mission_id, "landing")
    assert stage.vehicle.commands == sent
    stage.vehicle.touch_down()
    await stage.until_phase(mission_id, "done")
    assert "control_taken" not in stage.journal.kinds(mission_id)
    await stage.service.shut_down()


async def test_a_lost_console_holds_then_returns(stage: Stage) -> None:
    mission = spec().model_copy(update={"timers": TimerSpec(console_lost_hold_s=0.2, console_lost_return_s=0.6)})
    mission_id = await stage.service.create(mission, "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted
    await stage.until(mission_id, "took_off")
    stage.vehicle.stuck = True
    stage.publisher.consoles = 1
    await stage.until(mission_id, "flight_started")
    await stage.clock.sleep(2)
    assert "link_lost" not in stage.journal.kinds(mission_id)
    stage.publisher.consoles = 0
    await stage.until_phase(mission_id, "hold")
    await stage.until(mission_id, "return_ordered")
    phases = [e.after for e in stage.journal.events(mission_id) if isinstance(e, PhaseChanged)]
    assert phases[phases.index("hold") + 1] == "returning"


async def test_a_low_battery_turns_the_vehicle_home(stage: Stage) -> None:
    mission_id = await stuck(stage)
    stage.vehicle.stuck = False
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=26.0)
    assert "battery" in (await stage.until(mission_id, "return_ordered")).reason  # type: ignore[union-attr]


async def test_a_resume_on_the_ground_is_refused_until_the_battery_was_changed(stage: Stage) -> None:
    mission_id = await stuck(stage)
    stage.vehicle.touch_down()
    await stage.until_phase(mission_id, "hold")
    stage.vehicle.stuck = False
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=20.0)
    refused = await order(stage, mission_id, commands.Resume())
    assert "20 % battery" in refused.reason
    assert stage.service.status().phase == "hold"
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=95.0)
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until(mission_id, "place_reached")


async def test_facts_wait_for_a_database_that_is_away_and_nothing_is_lost_or_doubled(stage: Stage) -> None:
    mission_id = await flying(stage)
    stage.journal.away = True
    await asyncio.sleep(0.7)
    assert stage.service.status().database == "lost"
    stage.journal.away = False
    await stage.until_phase(mission_id, "landing")
    recorded = stage.journal.stored[mission_id]
    assert [r.seq for r in recorded] == list(range(1, len(recorded) + 1))
    assert fold(recorded).bearing_ids == tuple(
        e.bearing_id
        for e in stage.journal.events(mission_id)
        if e.kind == "bearing_measured"  # type: ignore[union-attr]
    )


async def test_a_vehicle_that_reports_no_battery_is_not_started_unless_the_mission_says_so(stage: Stage) -> None:
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=None)
    mission_id = await stage.service.create(spec(), "anna")
    assert not (await stage.service.preflight(mission_id)).passed
    refused = await order(stage, mission_id, commands.Start())
    assert "does not report its battery" in refused.reason
    knowing = await stage.service.create(spec(battery_telemetry=False), "anna")
    assert (await order(stage, knowing, commands.Start())).accepted


async def test_a_fact_that_cannot_be_stored_is_an_alert_and_the_flight_goes_on(stage: Stage) -> None:
    stage.journal.refuses = {"place_reached"}
    mission_id = await flying(stage)
    await stage.until(mission_id, "bearing_measured", 2)
    alerts = [e for e in stage.journal.events(mission_id) if e.kind == "alert_raised"]
    assert ["place_reached: a number is missing" in e.text for e in alerts] == [True]  # type: ignore[union-attr]
    assert [e.kind for e in stage.journal.aside][:2] == ["place_reached", "place_reached"]


async def test_a_fault_of_our_own_in_watching_holds_and_watching_goes_on(
    stage: Stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    mission_id = await stuck(stage)
    runner = stage.service._runner
    assert runner is not None
    tick, broken = type(runner.watch).tick, iter([True])

    def once(watch: object) -> None:
        if next(broken, False):
            raise ZeroDivisionError
        tick(watch)  # type: ignore[arg-type]

    monkeypatch.setattr(type(runner.watch), "tick", once)
    await stage.until_phase(mission_id, "hold")
    stage.vehicle.take_control()
    await stage.until_phase(mission_id, "manual")


async def test_without_a_vehicle_the_start_is_refused_with_a_remedy() -> None:
    stage = Stage()
    stage.vehicle.heard = False
    stage.vehicle.reachable = False
    await stage.service.start_up()
    mission_id = await stage.service.create(spec(), "anna")
    reply = await order(stage, mission_id, commands.Start())
    assert not reply.accepted
    assert reply.remedy
    checked = await stage.service.preflight(mission_id)
    assert not checked.passed
    await stage.service.shut_down()


async def test_a_receiver_that_is_gone_refuses_the_start(stage: Stage) -> None:
    stage.receiver.gone = True
    mission_id = await stage.service.create(spec(), "anna")
    reply = await order(stage, mission_id, commands.Start())
    assert not reply.accepted
    assert "receiver" in reply.reason
    assert stage.service.active_mission_id is None
