"""Missions in the air when a link, the battery, the receiver, the database or a pilot comes between."""

from __future__ import annotations

from dataclasses import replace
from uuid import uuid4

import pytest
from equipment import FRAME, spec
from flights import flying, order, stuck
from stage import REFUSED, Stage

from backend import commands
from backend.commands import Command
from backend.craft import inputs
from backend.events import (
    FIRST_CRAFT,
    AlertRaised,
    AuthorityChanged,
    BearingMeasured,
    LinkLost,
    PhaseChanged,
    Recorded,
    ReturnOrdered,
    SafetyVetoed,
)
from backend.mission.inputs import ToCraft
from backend.ports import JournalDamaged
from backend.reasons import PreflightFailed
from backend.reasons.flight import FailsafeFlies, Landed, NotStored, WatchBroke
from backend.reasons.safety import (
    BATTERY,
    BatteryShort,
    BatteryUnknown,
    FailsafeActs,
    FirstTurnBeyondCharge,
    NotGivenBack,
)
from backend.reasons.storage import MissionDamaged
from backend.spec import MissionSpec, Place, Polygon, TimerSpec
from hardware.reasons.receiver import ReceiverUnplugged
from planner.reason import remedy_of


def far_away(north_m: float) -> MissionSpec:
    """An area of 200 x 100 m that begins so far north of home, in a fence that holds both."""

    def area_of(south: float, east: float, north: float) -> Polygon:
        ring = [(-east, south), (east, south), (east, north), (-east, north), (-east, south)]
        return Polygon(coordinates=[[(p.lon, p.lat) for p in (FRAME.to_geo(x, y) for x, y in ring)]])

    found = spec(fence=area_of(-40.0, 140.0, north_m + 140.0))
    return found.model_copy(update={"area": area_of(north_m, 100.0, north_m + 100.0)})


def who_took(stage: Stage, mission_id: str) -> set[str]:
    """Who flew instead of us at any time."""
    changed = stage.journal.of_kind(mission_id, AuthorityChanged)
    return {fact.authority.who for fact in changed if fact.authority.who in ("pilot", "failsafe")}


async def test_a_vehicle_that_landed_at_home_while_it_was_not_heard_ends_the_mission(stage: Stage) -> None:
    mission_id = await stuck(stage)
    stage.vehicle.stuck = False
    assert (await order(stage, mission_id, commands.Return())).accepted
    await stage.until_phase(mission_id, "landing")
    stage.vehicle.heard = False
    await stage.until(mission_id, "link_lost")
    stage.vehicle.touch_down()
    stage.vehicle.heard = True
    await stage.until_mission(mission_id, "done")
    assert stage.vehicle.names.count("land") == 1
    assert not any(isinstance(alert.reason, Landed) for alert in stage.journal.of_kind(mission_id, AlertRaised))


async def test_a_mission_whose_facts_are_damaged_keeps_the_server_from_nothing(stage: Stage, monkeypatch) -> None:
    """Its craft is one that flies for no mission: hold, return and land reach it."""
    mission_id = await stuck(stage)
    read = stage.journal.read

    async def damaged(which: str, after: int = 0, most: int | None = None) -> list[Recorded]:
        if which == mission_id:
            raise JournalDamaged(MissionDamaged(mission_id, "it is cut off"))
        return await read(which, after, most)

    monkeypatch.setattr(stage.journal, "read", damaged)
    await stage.restart()
    assert stage.room.flights.active is None
    request = commands.CraftRequest(command_id=uuid4(), command=commands.Hold())
    reply = await stage.room.flights.command_craft(FIRST_CRAFT, request, commands.Author("anna"))
    assert reply.accepted, reply.reason


async def test_the_pilot_silences_the_mission_until_an_operator_resumes(stage: Stage) -> None:
    mission_id = await stuck(stage)
    stage.vehicle.pilot_takes_over()
    await stage.until_phase(mission_id, "manual")
    sent = list(stage.vehicle.commands)
    for command in (commands.Hold(), commands.Return(), commands.Override(place=Place(lat=50.0003, lon=7.0))):
        assert not (await order(stage, mission_id, command)).accepted
    await stage.clock.sleep(10)
    stage.vehicle.stuck = False
    refused = await order(stage, mission_id, commands.Resume())
    assert not refused.accepted
    assert refused.reason == NotGivenBack("POSCTL")
    assert stage.vehicle.commands == sent
    assert stage.vehicle.control.authority.who == "pilot"
    stage.vehicle.pilot_gives_back()
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
    stage.vehicle.shows("RETURN", after_silence=True)
    stage.vehicle.heard = True
    await stage.until(mission_id, "link_restored")
    return mission_id


@pytest.mark.parametrize(
    ("command", "sent"),
    [(commands.Hold(), ["hold"]), (commands.Return(), ["land"]), (commands.Abort(), ["hold", "land"])],
)
async def test_an_operator_may_take_the_vehicle_from_its_failsafe_which_is_no_pilot(
    stage: Stage, command: Command, sent: list[str]
) -> None:
    mission_id = await failsafe_flying(stage)
    last = stage.journal.of_kind(mission_id, AlertRaised)[-1]
    assert isinstance(last.reason, FailsafeFlies)
    assert (await order(stage, mission_id, command)).accepted
    await stage.until_true(lambda: stage.vehicle.names[-len(sent) :] == sent)
    await stage.until_true(lambda: stage.journal.state(mission_id).craft.open_alerts == ())
    assert who_took(stage, mission_id) == {"failsafe"}
    assert stage.journal.state(mission_id).craft.authority.who == "ours"


@pytest.mark.parametrize("command", [commands.Hold(), commands.Return(), commands.Land(), commands.Abort()])
async def test_an_order_in_the_moment_in_which_a_pilot_takes_the_vehicle_from_its_failsafe_leaves_it_to_them(
    stage: Stage, command: Command
) -> None:
    """The vehicle knows of the pilot, the mission has not looked yet."""
    mission_id = await failsafe_flying(stage)
    sent = list(stage.vehicle.commands)
    stage.vehicle.shows("POSCTL")
    await order(stage, mission_id, command)
    await stage.until_phase(mission_id, "manual")
    assert stage.vehicle.control.authority.who == "pilot"
    assert stage.vehicle.commands == sent


async def test_a_place_chosen_while_the_failsafe_flies_is_refused_with_its_name(stage: Stage) -> None:
    mission_id = await failsafe_flying(stage)
    refused = await order(stage, mission_id, commands.Override(place=Place(lat=50.0003, lon=7.0)))
    assert (refused.accepted, refused.reason) == (False, FailsafeActs("RETURN"))


async def test_a_step_that_finds_the_failsafe_flying_right_after_a_resume_takes_it_for_no_pilot(
    stage: Stage,
) -> None:
    mission_id = await stuck(stage)
    stage.vehicle.heard = False
    await stage.until_phase(mission_id, "hold")
    stage.vehicle.heard = True
    await stage.until(mission_id, "link_restored")
    goto = stage.vehicle.goto

    async def failsafe_first(*place: object) -> None:
        stage.vehicle.shows("RETURN", after_silence=True)
        await goto(*place)  # type: ignore[arg-type]

    stage.vehicle.goto = failsafe_first  # type: ignore[method-assign]
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until_true(lambda: stage.active.state.phase == "hold")
    await stage.until_phase(mission_id, "hold")
    assert who_took(stage, mission_id) == {"failsafe"}


async def test_without_a_console_the_failsafes_own_return_is_left_to_bring_the_vehicle_home() -> None:
    stage = Stage()
    await stage.room.start_up()
    mission_id = await failsafe_flying(stage)
    runner = stage.active
    sent = list(stage.vehicle.commands)
    runner.give(ToCraft(FIRST_CRAFT, inputs.TimerExpired("console_return")))
    await stage.until_phase(mission_id, "landing")
    assert stage.vehicle.commands == sent
    stage.vehicle.touch_down()
    await stage.until_mission(mission_id, "done")
    assert who_took(stage, mission_id) == {"failsafe"}
    await stage.room.shut_down()


async def test_a_lost_console_holds_then_returns(stage: Stage) -> None:
    mission = spec().model_copy(update={"timers": TimerSpec(console_lost_hold_s=0.2, console_lost_return_s=0.6)})
    mission_id = await stage.room.drafts.create(mission, "anna")
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
    ordered = await stage.until(mission_id, "return_ordered")
    assert isinstance(ordered, ReturnOrdered)
    assert isinstance(ordered.reason, BatteryShort)


async def test_a_resume_on_the_ground_is_refused_until_the_battery_was_changed(stage: Stage) -> None:
    mission_id = await stuck(stage)
    stage.vehicle.touch_down()
    await stage.until_phase(mission_id, "hold")
    stage.vehicle.stuck = False
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=20.0)
    refused = await order(stage, mission_id, commands.Resume())
    assert isinstance(refused.reason, BATTERY)
    assert stage.active.state.phase == "hold"
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=95.0)
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until(mission_id, "place_reached")


@pytest.mark.parametrize("planned", [True, False])
async def test_a_resume_on_the_ground_stays_there_where_the_battery_does_not_last_for_the_next_turn(
    stage: Stage, planned: bool
) -> None:
    """It took off, came home from above home, and the search was over."""
    mission_id = await stage.room.drafts.create(far_away(250.0), "anna")
    assert (await order(stage, mission_id, commands.Start())).accepted
    await stage.until(mission_id, "took_off")
    stage.vehicle.stuck = True
    await stage.until(mission_id, "flight_started")
    assert (await order(stage, mission_id, commands.Hold())).accepted
    if not planned:
        assert (await order(stage, mission_id, commands.Veto())).accepted
    stage.vehicle.stuck = False
    stage.vehicle.touch_down()
    await stage.until(mission_id, "alert_raised")
    sent = list(stage.vehicle.names)
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=60.0)
    assert (await order(stage, mission_id, commands.Resume())).accepted
    vetoed = await stage.until(mission_id, "safety_vetoed")
    assert isinstance(vetoed, SafetyVetoed)
    assert isinstance(vetoed.reason, FirstTurnBeyondCharge)
    assert stage.active.state.phase == "hold"
    assert stage.vehicle.names == sent
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=95.0)
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until(mission_id, "place_reached")


async def test_facts_wait_for_a_database_that_is_away_and_nothing_is_lost_or_doubled(stage: Stage) -> None:
    mission_id = await flying(stage)
    stage.journal.away = True
    await stage.until_true(lambda: stage.room.display.status().database == "unstored")
    stage.journal.away = False
    await stage.until_phase(mission_id, "landing")
    recorded = stage.journal.stored[mission_id]
    assert [r.seq for r in recorded] == list(range(1, len(recorded) + 1))
    assert stage.journal.state(mission_id).search.measured == tuple(stage.journal.of_kind(mission_id, BearingMeasured))


async def test_a_vehicle_that_reports_no_battery_is_not_started_unless_the_mission_says_so(stage: Stage) -> None:
    stage.vehicle.state = replace(stage.vehicle.state, battery_percent=None)
    mission_id = await stage.room.drafts.create(spec(), "anna")
    assert not (await stage.room.drafts.preflight(mission_id)).passed
    refused = await order(stage, mission_id, commands.Start())
    assert refused.reason == PreflightFailed("safety", BatteryUnknown())
    knowing = await stage.room.drafts.create(spec(battery_telemetry=False), "anna")
    assert (await order(stage, knowing, commands.Start())).accepted


async def test_a_fact_that_cannot_be_stored_is_an_alert_and_the_flight_goes_on(stage: Stage) -> None:
    stage.journal.refuses = {"place_reached"}
    mission_id = await flying(stage)
    await stage.until(mission_id, "bearing_measured", 2)
    (alert,) = stage.journal.of_kind(mission_id, AlertRaised)
    assert isinstance(alert.reason, NotStored)
    assert "place_reached" in alert.reason.detail
    assert REFUSED.detail in alert.reason.detail
    assert [e.kind for e in stage.journal.aside][:2] == ["place_reached", "place_reached"]


async def test_a_fault_of_our_own_in_watching_holds_and_watching_goes_on(
    stage: Stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    mission_id = await stuck(stage)
    watch = stage.active.crafts[FIRST_CRAFT].watch
    tick, broken = type(watch).tick, iter([True])

    def once(ticking: object) -> None:
        if next(broken, False):
            raise ZeroDivisionError
        tick(ticking)  # type: ignore[arg-type]

    monkeypatch.setattr(type(watch), "tick", once)
    await stage.until_phase(mission_id, "hold")
    (alert,) = stage.journal.of_kind(mission_id, AlertRaised)
    assert (alert.topic, alert.reason) == ("failure", WatchBroke("vehicle"))
    stage.vehicle.pilot_takes_over()
    await stage.until_phase(mission_id, "manual")
    assert stage.active.state.crafts[FIRST_CRAFT].taken_over, "what came after the fault was seen"


async def test_without_a_vehicle_the_start_is_refused_with_a_remedy() -> None:
    stage = Stage()
    stage.vehicle.heard = False
    stage.vehicle.reachable = False
    await stage.room.start_up()
    mission_id = await stage.room.drafts.create(spec(), "anna")
    reply = await order(stage, mission_id, commands.Start())
    assert not reply.accepted
    assert reply.reason is not None
    assert remedy_of(reply.reason)
    checked = await stage.room.drafts.preflight(mission_id)
    assert not checked.passed
    await stage.room.shut_down()


async def test_a_receiver_that_is_gone_refuses_the_start(stage: Stage) -> None:
    stage.receiver.gone = True
    mission_id = await stage.room.drafts.create(spec(), "anna")
    reply = await order(stage, mission_id, commands.Start())
    assert not reply.accepted
    assert reply.reason == PreflightFailed("receiver", ReceiverUnplugged())
    assert stage.room.flights.active is None


async def test_a_vehicle_that_a_pilot_brought_low_climbs_on_the_spot_before_it_flies_on(stage: Stage) -> None:
    mission_id = await stuck(stage)
    stage.vehicle.pilot_takes_over()
    await stage.until_phase(mission_id, "manual")
    stage.vehicle.state = replace(stage.vehicle.state, altitude_amsl_m=103.0, altitude_relative_m=3.0)
    here, before = stage.vehicle.state.position, len(stage.vehicle.flown)
    stage.vehicle.pilot_gives_back()
    stage.vehicle.stuck = False
    assert (await order(stage, mission_id, commands.Resume())).accepted
    await stage.until_true(lambda: len(stage.vehicle.flown) > before + 1)
    climb, there = stage.vehicle.flown[before : before + 2]
    assert climb == (here, 140.0)
    assert there[0] != here
