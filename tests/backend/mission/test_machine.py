"""The machine in every state against every input, and the rules that must hold on any walk through it."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from missions import (
    BATTERY_VETO,
    HOME,
    MOVES,
    PHASES,
    SPEC,
    VETO,
    WAITING_SPEC,
    Walk,
    answer,
    bearing,
    belief_ready,
    commanded,
    every_input,
    kinds,
    moves,
    plan,
    rejected,
    walk_in,
)

from backend import commands
from backend.events import AlertRaised, MissionEnded
from backend.mission import effects as asked
from backend.mission import inputs
from backend.mission.effects import Effect
from backend.mission.machine import transition
from backend.mission.safety import Veto
from backend.mission.state import AUTOMATIC, HOMEWARD, TERMINAL, MissionState, fold

VEHICLE = (*MOVES, asked.HoldVehicle)
IN_FLIGHT = tuple(AUTOMATIC | HOMEWARD)


def check_rules(before: MissionState, given_: inputs.Input, after: MissionState, effects: tuple[Effect, ...]) -> None:
    """What holds for any state and input."""
    command = given_.command if isinstance(given_, inputs.Commanded) else None
    if before.pilot_has_control and not isinstance(command, commands.Resume):
        assert not any(isinstance(e, VEHICLE) for e in effects), "a command went out while the pilot had control"
    if before.phase in ("hold", "manual") and moves(effects):
        ordered = isinstance(command, commands.Resume | commands.Return | commands.Abort)
        timer = isinstance(given_, inputs.TimerExpired) and given_.name == "console_return"
        assert ordered or timer, f"{given_} moved a held vehicle"
    if isinstance(command, commands.Resume) and given_.objections:  # type: ignore[union-attr]
        assert not any(isinstance(e, (*VEHICLE, asked.ReleasePilotLatch)) for e in effects)
        assert (after.phase, after.pilot_has_control) == (before.phase, before.pilot_has_control)
    if before.phase in TERMINAL:
        assert after.phase == before.phase
        assert after.outcome == before.outcome
    if isinstance(given_, inputs.PilotTookOver):
        assert not any(isinstance(e, VEHICLE) for e in effects)
        assert after.phase == "manual" or before.phase in TERMINAL or not before.started_at_s
    if before.phase in IN_FLIGHT and answered_first(before, given_):
        if isinstance(command, commands.Hold):
            assert after.phase == "hold"
            assert kinds(effects)[:2] == [asked.CancelWork, asked.HoldVehicle]
        if isinstance(command, commands.Abort):
            assert after.phase == "aborted"
            assert effects[:2] == (asked.CancelWork(), asked.ReturnHome(hold_first=True))
    if command is not None:
        assert sum(isinstance(e, asked.Reply) for e in effects) == 1
        assert given_.command_id in after.answered  # type: ignore[union-attr]
    if after.outcome is not None:
        assert after.phase in TERMINAL


def answered_first(before: MissionState, given_: inputs.Input) -> bool:
    return isinstance(given_, inputs.Commanded) and given_.command_id not in before.answered


@pytest.mark.parametrize("phase", PHASES)
def test_every_input_is_answered_in_every_phase(phase: str) -> None:
    start = walk_in(phase).state
    assert start.phase == phase
    for given_ in every_input(start):
        after, effects = transition(start, given_, 2_000.0)
        check_rules(start, given_, after, effects)
        for again in every_input(after):
            twice, more = transition(after, again, 2_001.0)
            check_rules(after, again, twice, more)


@settings(max_examples=150, deadline=None)
@given(automatic=st.booleans(), picks=st.lists(st.integers(0, 10_000), min_size=5, max_size=60))
def test_on_any_walk_the_rules_hold_and_the_journal_gives_the_state_back(automatic: bool, picks: list[int]) -> None:
    walk = Walk(SPEC if automatic else WAITING_SPEC)
    if picks[0] % 3:
        walk.to("planning")
    ended = 0
    for number, pick in enumerate(picks):
        choices = every_input(walk.state)
        given_ = choices[pick % len(choices)]
        if isinstance(given_, inputs.Commanded):
            given_ = commanded(
                given_.command, f"walk-{number}", objections=given_.objections, on_ground=given_.on_ground
            )
        before = walk.state
        effects = walk.give(given_)
        check_rules(before, given_, walk.state, effects)
        ended += sum(isinstance(e, asked.Record) and isinstance(e.event, MissionEnded) for e in effects)
        assert ended <= 1
    assert fold(walk.recorded) == walk.state


def test_a_localized_mission_goes_from_draft_to_done() -> None:
    walk = Walk()
    walk.command(commands.Start())
    assert walk.state.phase == "taking_off"
    assert kinds(walk.give(inputs.InTheAir(HOME, 40.0)))[-1] is asked.UpdateBelief
    for number in (1, 2):
        effects = walk.give(belief_ready(walk.state))
        assert effects[-1] == asked.PlanNext(number, ())
        effects = walk.give(inputs.Planned(plan(number)))
        assert effects[-1] == asked.FlyTo(number, plan(number).place, 140.0, 7.0)
        assert walk.give(inputs.Arrived(HOME, 0.3, 9.0))[-1] == asked.Measure(number, 1)
        walk.give(inputs.SweepTaken(bearing(number)))
    localized_at = walk.at_s + 1
    assert walk.give(belief_ready(walk.state, localized=True))[-1] == asked.ReturnHome()
    walk.give(inputs.HomeReached())
    assert walk.state.phase == "landing"
    walk.give(inputs.Landed())
    assert (walk.state.phase, walk.state.outcome) == ("done", "localized")
    ended = next(r.event for r in walk.recorded if isinstance(r.event, MissionEnded))
    started = next(r for r in walk.recorded if r.event.kind == "mission_started").at_utc.timestamp()
    assert ended.mission_time_s == localized_at - started


def test_rejected_sweeps_are_taken_again_and_then_another_place_is_chosen() -> None:
    walk = Walk().to("measuring")
    place = walk.state.chosen.place if walk.state.chosen else None
    assert walk.give(inputs.SweepRefused(rejected(1)))[-1] == asked.Measure(1, 2)
    effects = walk.give(inputs.SweepRefused(rejected(2)))
    assert effects[-1] == asked.PlanNext(2, (place,))
    assert walk.state.phase == "planning"


def test_a_mission_that_ran_out_of_places_goes_home_honestly() -> None:
    walk = Walk().to("planning")
    for number in range(1, SPEC.localization.maximum_bearings + 1):
        walk.give(belief_ready(walk.state))
        walk.give(inputs.Planned(plan(number)))
        walk.give(inputs.Arrived(HOME, 0.3, 9.0))
        walk.give(inputs.SweepTaken(bearing(number)))
    walk.give(belief_ready(walk.state))
    assert walk.state.phase == "returning"
    walk.give(inputs.Landed())
    ended = walk.recorded[-2].event
    assert isinstance(ended, MissionEnded)
    assert ended.outcome == "not_localized"
    assert "4 places" in ended.reason
    assert "not yet: too few" in ended.reason


def test_nothing_left_to_plan_goes_home_not_localized() -> None:
    walk = Walk().to("planning")
    walk.give(belief_ready(walk.state))
    walk.give(inputs.NothingToPlan("every place is forbidden"))
    walk.give(inputs.Landed())
    assert walk.state.outcome == "not_localized"


def test_after_a_lost_link_the_failsafe_that_brings_the_vehicle_home_is_not_interrupted() -> None:
    walk = Walk().to("flying")
    walk.give(inputs.LinkDown("vehicle", "silent"))
    effects = walk.give(inputs.LinkUp("vehicle", 12.0, going_home=True))
    assert not any(isinstance(e, VEHICLE) for e in effects)
    assert any("on its own way home" in r.event.text for r in walk.recorded if r.event.kind == "alert_raised")
    assert moves(walk.command(commands.Resume())) or walk.state.phase == "planning"


def test_a_failsafe_that_acts_right_after_a_restart_leaves_the_mission_in_hold_and_may_be_resumed_from() -> None:
    walk = Walk().to("flying")
    walk.give(inputs.Restarted(pilot=False, going_home=False, detail="back"))
    effects = walk.give(inputs.FailsafeActs("RETURN"))
    assert not any(isinstance(e, VEHICLE) for e in effects)
    assert walk.state.phase == "hold"
    assert not walk.state.pilot_has_control
    assert answer(walk.command(commands.Resume())).accepted


def test_the_pilot_in_control_is_never_commanded_not_even_by_hold_return_or_abort() -> None:
    for command in (commands.Hold(), commands.Return(), commands.Abort(), commands.Override(place=HOME)):
        walk = Walk().to("manual")
        effects = walk.command(command)
        assert not any(isinstance(e, VEHICLE) for e in effects)
    assert Walk().to("manual").command(commands.Abort())
    walk = Walk().to("manual")
    walk.command(commands.Abort())
    assert walk.state.outcome == "aborted"


def test_a_pilot_landing_ends_the_mission_and_what_was_to_be_watched_in_flight() -> None:
    walk = Walk().to("manual")
    walk.give(inputs.BatteryLow("just enough"))
    walk.give(inputs.Landed())
    assert not walk.state.open_alerts
    assert (walk.state.phase, walk.state.outcome) == ("done", "not_localized")


def test_who_has_control_is_not_claimed_where_it_may_be_the_failsafe() -> None:
    for perhaps_failsafe, who in ((False, "the pilot has"), (True, "the pilot or the autopilot's own failsafe has")):
        walk = Walk().to("flying")
        walk.give(inputs.PilotTookOver("RTL", "the vehicle is in RTL", perhaps_failsafe))
        (told,) = [r.event for r in walk.recorded if isinstance(r.event, AlertRaised)]
        assert told.text == f"{who} control: the vehicle is in RTL"


def test_a_failsafe_that_landed_or_gave_way_to_the_pilot_is_no_longer_said_to_fly() -> None:
    for after in (inputs.Landed(), inputs.PilotTookOver("POSCTL", "stick")):
        walk = Walk().to("hold")
        walk.give(inputs.FailsafeActs("RETURN"))
        walk.give(after)
        assert not any(alert.startswith("vehicle") for alert in walk.state.open_alerts)
        assert walk.state.open_alerts
    lost = Walk().to("hold")
    lost.give(inputs.LinkDown("vehicle", "silent"))
    lost.give(inputs.PilotTookOver("POSCTL", "stick"))
    assert any(alert.startswith("vehicle") for alert in lost.state.open_alerts)


def test_a_mission_whose_bearing_was_excluded_on_the_way_home_does_not_say_that_it_is_localized() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1)))
    walk.give(belief_ready(walk.state, localized=True))
    assert walk.state.phase == "returning"
    walk.command(commands.ExcludeBearing(bearing_id="b1"))
    walk.give(belief_ready(walk.state))
    walk.give(inputs.Landed())
    (ended,) = [r.event for r in walk.recorded if isinstance(r.event, MissionEnded)]
    assert ended.outcome == "not_localized"
    assert ended.reason == "no longer localized since a bearing was excluded (not yet: too few)"


def test_a_vehicle_that_landed_by_itself_waits_on_the_ground_and_takes_off_again_on_resume() -> None:
    for phase in ("hold", "flying"):
        walk = Walk().to(phase)
        effects = walk.give(inputs.Landed())
        assert not moves(effects)
        assert walk.state.phase == "hold"
        assert walk.give(inputs.Landed()) == ()
        effects = walk.command(commands.Resume(), on_ground=True)
        assert moves(effects) == [asked.TakeOff(SPEC.flight.altitude_relative_m)]
        assert walk.state.phase == "taking_off"
        assert not walk.state.open_alerts
        walk.give(inputs.InTheAir(HOME, 40.0))
        assert walk.state.phase == "flying"


def test_a_localized_mission_whose_vehicle_landed_in_hold_is_done() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1)))
    walk.command(commands.Hold())
    walk.give(belief_ready(walk.state, localized=True))
    walk.give(inputs.Landed())
    assert (walk.state.phase, walk.state.outcome) == ("done", "localized")


def test_a_place_that_jumped_is_told_until_a_bearing_comes_from_a_sure_one() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1).model_copy(update={"drift_m": 30.0})))
    told = [r.event for r in walk.recorded if isinstance(r.event, AlertRaised)]
    assert [(alert.level, alert.text) for alert in told] == [
        ("caution", "the place of bearing 1 is unsure by 30 m; it counts for less")
    ]
    walk.give(belief_ready(walk.state))
    walk.give(inputs.Planned(plan(2)))
    walk.give(inputs.Arrived(HOME, 0.3, 9.0))
    assert walk.state.open_alerts
    walk.give(inputs.SweepTaken(bearing(2)))
    assert not walk.state.open_alerts


def test_the_end_of_a_claim_against_a_bearing_says_so() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1)))
    ready = belief_ready(walk.state, localized=True)
    walk.give(inputs.BeliefReady(ready.bearing_ids, ready.fact.model_copy(update={"contradicting": ["b1"]})))
    walk.give(inputs.Landed())
    ended = next(r.event for r in walk.recorded if isinstance(r.event, MissionEnded))
    assert ended.reason == "the expected error is below the threshold; it stands against 1 of 1 bearings"


def test_a_restart_in_flight_holds_and_rebuilds_the_belief() -> None:
    for phase in IN_FLIGHT:
        walk = walk_in(phase)
        effects = walk.give(inputs.Restarted(pilot=False, going_home=False, detail="back"))
        assert walk.state.phase == "hold"
        assert not moves(effects)
        assert asked.UpdateBelief() in effects
        walk.give(belief_ready(walk.state))
        assert walk.state.phase == "hold"
        assert moves(walk.command(commands.Resume())) or walk.state.phase in ("planning", "waiting")


def test_a_restart_does_not_touch_a_vehicle_that_a_pilot_flies() -> None:
    for walk, pilot in ((Walk().to("flying"), True), (Walk().to("manual"), False)):
        effects = walk.give(inputs.Restarted(pilot=pilot, going_home=False, detail="back"))
        assert not any(isinstance(e, VEHICLE) for e in effects)
        assert walk.state.phase == "manual"


def test_a_restart_does_not_interrupt_the_failsafe_that_brings_the_vehicle_home() -> None:
    walk = Walk().to("flying")
    effects = walk.give(inputs.Restarted(pilot=False, going_home=True, detail="back"))
    assert walk.state.phase == "hold"
    assert not any(isinstance(e, VEHICLE) for e in effects)
    homeward = Walk().to("returning")
    homeward.give(inputs.Restarted(pilot=False, going_home=True, detail="back"))
    whys = [[r.event.text for r in w.recorded if isinstance(r.event, AlertRaised)] for w in (walk, homeward)]
    assert ["failsafe" in text for (text,) in whys] == [True, False]
    effects = walk.command(commands.Resume())
    assert asked.ReleasePilotLatch() in effects
    assert not walk.state.open_alerts


def test_a_lost_console_holds_and_then_returns_by_timers() -> None:
    walk = Walk().to("flying")
    effects = walk.give(inputs.LinkDown("console", "no browser"))
    timers = SPEC.timers
    assert asked.StartTimer("console_hold", timers.console_lost_hold_s) in effects
    assert asked.StartTimer("console_return", timers.console_lost_return_s) in effects
    walk.give(inputs.TimerExpired("console_hold"))
    assert walk.state.phase == "hold"
    assert moves(walk.give(inputs.TimerExpired("console_return"))) == [asked.ReturnHome()]
    back = Walk().to("flying")
    back.give(inputs.LinkDown("console", "no browser"))
    effects = back.give(inputs.LinkUp("console", 4.0))
    assert asked.CancelTimer("console_hold") in effects
    assert asked.CancelTimer("console_return") in effects
    assert back.state.phase == "flying"


def test_a_lost_vehicle_link_holds_and_on_return_the_hold_is_sent() -> None:
    walk = Walk().to("flying")
    effects = walk.give(inputs.LinkDown("vehicle", "3 s without telemetry"))
    assert walk.state.phase == "hold"
    assert asked.CancelWork() in effects
    assert not answer(walk.command(commands.Resume())).accepted
    assert asked.HoldVehicle() in walk.give(inputs.LinkUp("vehicle", 5.0))
    assert answer(walk.command(commands.Resume())).accepted


@pytest.mark.parametrize("ordered", [commands.Return(), inputs.TimerExpired("console_return")])
def test_a_way_home_ordered_over_a_lost_link_is_ordered_again_when_the_vehicle_is_heard(ordered: object) -> None:
    walk = Walk().to("flying")
    walk.give(inputs.LinkDown("vehicle", "silent"))
    if isinstance(ordered, commands.Return):
        walk.command(ordered)
    else:
        walk.give(ordered)  # type: ignore[arg-type]
    walk.give(inputs.WorkFailed("return", "no answer", "look", in_air=True))
    assert walk.state.phase == "returning"
    told = [r.event for r in walk.recorded if isinstance(r.event, AlertRaised)][-1]
    assert told.remedy == "it is ordered again when the vehicle is heard"
    assert moves(walk.give(inputs.LinkUp("vehicle", 9.0))) == [asked.ReturnHome()]
    assert not walk.state.open_alerts
    walk.give(inputs.WorkFailed("return", "refused", "look", in_air=True))
    assert walk.state.phase == "hold"


def test_an_abort_over_a_lost_link_is_ordered_again_when_the_vehicle_is_heard_unless_it_was_held_since() -> None:
    for lost_first in (True, False):
        walk = Walk().to("flying")
        steps = [lambda w: w.give(inputs.LinkDown("vehicle", "silent")), lambda w: w.command(commands.Abort())]
        for step in steps if lost_first else reversed(steps):
            step(walk)
        walk.give(inputs.WorkFailed("return", "no answer", "look", in_air=True))
        assert moves(walk.give(inputs.LinkUp("vehicle", 9.0))) == [asked.ReturnHome()]
        assert not walk.state.open_alerts
        walk.give(inputs.LinkDown("vehicle", "silent"))
        walk.command(commands.Hold())
        effects = walk.give(inputs.LinkUp("vehicle", 9.0))
        assert [e for e in effects if isinstance(e, VEHICLE)] == [asked.HoldVehicle()]


def test_a_fault_of_our_own_does_not_stop_the_way_home() -> None:
    for phase in HOMEWARD:
        walk = Walk().to(phase)
        effects = walk.give(inputs.WorkFailed("hold", "watching failed inside Crossfix", "look", in_air=True))
        assert walk.state.phase == phase
        assert not any(isinstance(e, (*VEHICLE, asked.CancelWork)) for e in effects)
        assert walk.state.open_alerts


def test_a_silent_receiver_holds_only_a_running_measurement() -> None:
    flying = Walk().to("flying")
    flying.give(inputs.LinkDown("receiver", "silent"))
    assert flying.state.phase == "flying"
    measuring = Walk().to("measuring")
    measuring.give(inputs.LinkDown("receiver", "silent for 5 s"))
    assert measuring.state.phase == "hold"
    assert any(a.startswith("receiver") for a in measuring.state.open_alerts)
    measuring.give(inputs.LinkUp("receiver", 9.0))
    assert not any(a.startswith("receiver") for a in measuring.state.open_alerts)


def test_a_low_battery_brings_the_vehicle_home() -> None:
    stale = Veto("battery_stale", "no longer reported", "look")
    for given_ in (
        inputs.BatteryLow("just enough"),
        inputs.WorkVetoed((BATTERY_VETO,)),
        inputs.WorkVetoed((stale, BATTERY_VETO)),
    ):
        walk = Walk().to("flying")
        assert moves(walk.give(given_)) == [asked.ReturnHome()]
        assert walk.state.phase == "returning"


def test_the_alert_of_an_unknown_charge_is_cleared_when_it_is_reported_again() -> None:
    walk = Walk().to("hold")
    walk.give(inputs.BatteryLow("the battery's charge is no longer reported"))
    assert any(a.startswith("battery") for a in walk.state.open_alerts)
    walk.give(inputs.BatteryReported())
    assert not any(a.startswith("battery") for a in walk.state.open_alerts)


def test_a_vetoed_flight_holds_and_says_why() -> None:
    walk = Walk().to("flying")
    effects = walk.give(inputs.WorkVetoed((VETO,)))
    assert walk.state.phase == "hold"
    assert not moves(effects)
    assert any(a.startswith("safety") for a in walk.state.open_alerts)


def test_a_failed_take_off_on_the_ground_ends_the_mission_and_in_the_air_holds() -> None:
    ground, air = Walk().to("taking_off"), Walk().to("taking_off")
    ground.give(inputs.WorkFailed("take_off", "did not arm", "look", in_air=False))
    air.give(inputs.WorkFailed("take_off", "no altitude", "look", in_air=True))
    assert (ground.state.phase, ground.state.outcome) == ("failed", "failed")
    assert air.state.phase == "hold"


def test_an_offset_common_to_all_bearings_is_told_until_it_is_none() -> None:
    walk = Walk().to("measuring")
    walk.give(inputs.SweepTaken(bearing(1)))
    ready = belief_ready(walk.state)
    doubted = ready.fact.model_copy(update={"heading_offset_deg": 12.4, "heading_offset_std_error_deg": 1.6})
    walk.give(inputs.BeliefReady(ready.bearing_ids, doubted))
    (told,) = [r.event for r in walk.recorded if isinstance(r.event, AlertRaised)]
    assert told.level == "caution"
    assert "about +12 ± 2 degrees" in told.text
    walk.give(inputs.Planned(plan(2)))
    walk.give(inputs.Arrived(HOME, 0.3, 9.0))
    assert walk.state.open_alerts
    walk.give(inputs.SweepTaken(bearing(2)))
    walk.give(belief_ready(walk.state))
    assert not walk.state.open_alerts


def test_a_stale_belief_is_not_recorded() -> None:
    walk = Walk().to("measuring")
    old = belief_ready(walk.state, localized=True)
    walk.give(inputs.SweepTaken(bearing(1)))
    assert walk.give(old) == ()
