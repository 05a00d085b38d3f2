"""What the machine answers to a pilot, a failsafe, a lost link, a restart and a fault."""

from __future__ import annotations

import pytest
from missions import (
    BATTERY_VETO,
    HOME,
    MOVES,
    SPEC,
    VETO,
    Walk,
    answer,
    belief_ready,
    moves,
    walk_in,
)

from backend import commands
from backend.events import AlertRaised
from backend.mission import effects as asked
from backend.mission import inputs
from backend.mission.safety import Veto
from backend.mission.state import AUTOMATIC, HOMEWARD

VEHICLE = (*MOVES, asked.HoldVehicle)
IN_FLIGHT = tuple(AUTOMATIC | HOMEWARD)


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


def test_a_failsafe_that_acts_right_after_a_resume_holds_the_mission_and_is_not_fought() -> None:
    for phase in AUTOMATIC:
        walk = walk_in(phase)
        effects = walk.give(inputs.FailsafeActs("RETURN"))
        assert not any(isinstance(e, VEHICLE) for e in effects)
        assert asked.CancelWork() in effects
        assert walk.state.phase == "hold"
        assert not walk.state.pilot_has_control


def test_a_failsafe_that_an_order_of_ours_has_stopped_leaves_the_mission_in_hold_and_sends_nothing() -> None:
    walk = Walk().to("flying")
    walk.give(inputs.FailsafeActs("RETURN"))
    effects = walk.give(inputs.FailsafeStopped("HOLD"))
    assert not any(isinstance(e, (*VEHICLE, asked.ReleasePilotLatch)) for e in effects)
    assert walk.state.phase == "hold"
    (told,) = walk.state.open_alerts
    assert told.startswith("vehicle-")
    walk.command(commands.Hold(), failsafe_flies=True)
    assert not walk.state.open_alerts


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
