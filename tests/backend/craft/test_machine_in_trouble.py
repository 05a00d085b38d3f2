"""What the craft machine answers to a pilot, a failsafe, a lost link and a fault."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import pytest
from craft_walk import VEHICLE, CraftWalk, craft_in, moves, refusal, sent
from facts import (
    BATTERY_VETO,
    BROKE,
    FAILSAFE,
    GIVEN_BACK,
    HOME,
    LINK_LOST,
    NAMED_FAILSAFE,
    NO_ANSWER,
    NO_TAKE_OFF,
    OURS,
    PERHAPS_PILOT,
    PILOT,
    RECEIVER_SILENT,
    SILENT_BATTERY,
    SPEC,
    VETO,
)

from backend import commands
from backend.craft import effects, inputs
from backend.craft.state import AUTOMATIC, HOMEWARD
from backend.events import AlertRaised, AuthorityChanged, Phase
from backend.reasons import NotDone, OrderedAgainLater, ReceiverTrouble
from backend.reasons.flight import FailsafeFlies, FailsafeStopped, Landed, PilotFlies, PlaceUnknown
from backend.reasons.safety import NoLink


def test_after_a_lost_link_the_failsafe_that_brings_the_vehicle_home_is_not_interrupted() -> None:
    walk = CraftWalk().to("flying")
    walk.give(inputs.LinkDown("vehicle", LINK_LOST))
    assert not sent(walk.give(inputs.AuthorityHeard(FAILSAFE)))
    assert not sent(walk.give(inputs.LinkUp("vehicle", 12.0)))
    assert walk.last_alert.reason == FailsafeFlies("link_lost")
    assert walk.topics == ["vehicle"]
    assert moves(walk.order(commands.Resume()))


def test_a_failsafe_that_acts_right_after_a_restart_leaves_the_craft_in_hold_and_may_be_resumed_from() -> None:
    walk = CraftWalk().to("flying")
    walk.give(inputs.Restarted(OURS))
    assert not sent(walk.give(inputs.AuthorityHeard(FAILSAFE)))
    assert walk.craft.phase == "hold"
    assert not walk.craft.taken_over
    assert refusal(walk.order(commands.Resume())) is None
    assert walk.craft.authority.who == "ours"


def test_a_failsafe_that_acts_holds_the_craft_and_is_not_fought() -> None:
    for phase in AUTOMATIC:
        walk = craft_in(phase)
        asked = walk.give(inputs.AuthorityHeard(FAILSAFE))
        assert not sent(asked)
        assert effects.CancelWork() in asked
        assert walk.craft.phase == "hold"
        assert not walk.craft.taken_over
        assert walk.last_alert.reason == FailsafeFlies("silence")


@pytest.mark.parametrize("cause", ["battery", "transmitter", "position", "fence", "other"])
def test_a_failsafe_whose_cause_the_autopilot_named_is_said_with_it_also_after_it_counted_as_a_pilots(
    cause: Literal["battery", "transmitter", "position", "fence", "other"],
) -> None:
    named = replace(FAILSAFE, cause=cause)
    for before in (OURS, PERHAPS_PILOT):
        walk = CraftWalk().to("flying")
        walk.give(inputs.AuthorityHeard(before))
        asked = walk.give(inputs.AuthorityHeard(named))
        assert not sent(asked)
        assert effects.CancelWork() in asked
        assert (walk.craft.phase, walk.craft.taken_over, walk.topics) == ("hold", False, ["vehicle"])
        assert walk.last_alert.reason == FailsafeFlies(cause)
        assert refusal(walk.order(commands.Hold())) is None
        assert walk.craft.authority.who == "ours"
    again = CraftWalk().to("flying")
    again.give(inputs.Restarted(named))
    assert again.last_alert.reason == FailsafeFlies(cause)


def test_the_cause_that_is_named_last_is_said_and_of_a_silence_what_was_said_of_it_before() -> None:
    walk = CraftWalk().to("flying")
    walk.give(inputs.AuthorityHeard(replace(FAILSAFE, cause="silence")))
    assert walk.last_alert.reason == FailsafeFlies("silence")
    walk.give(inputs.AuthorityHeard(replace(FAILSAFE, cause="battery")))
    assert walk.last_alert.reason == FailsafeFlies("battery")
    assert walk.topics == ["vehicle"]


@pytest.mark.parametrize("phase", sorted(HOMEWARD))
def test_a_named_failsafe_on_the_way_home_is_said_and_the_phase_stays(phase: Phase) -> None:
    walk = craft_in(phase)
    asked = walk.give(inputs.AuthorityHeard(replace(FAILSAFE, cause="battery")))
    assert not sent(asked)
    assert (walk.craft.phase, walk.topics) == (phase, ["vehicle"])


def test_a_failsafe_that_an_order_has_stopped_leaves_the_craft_in_hold_and_sends_nothing() -> None:
    walk = CraftWalk().to("flying")
    walk.give(inputs.AuthorityHeard(FAILSAFE))
    asked = walk.give(inputs.FailsafeEnded("HOLD"))
    assert not any(isinstance(e, (*VEHICLE, effects.TakeControl)) for e in asked)
    assert walk.craft.phase == "hold"
    assert walk.topics == ["vehicle"]
    assert walk.last_alert.reason == FailsafeStopped("HOLD")
    walk.order(commands.Hold())
    assert not walk.topics


@pytest.mark.parametrize("phase", sorted(HOMEWARD))
def test_a_failsafe_that_ends_on_the_way_home_is_said_and_leaves_everything_as_it_is(phase: Phase) -> None:
    walk = craft_in(phase)
    walk.give(inputs.AuthorityHeard(FAILSAFE))
    before = walk.craft
    asked = walk.give(inputs.FailsafeEnded("LOITER"))
    assert not any(isinstance(e, (*VEHICLE, effects.CancelWork, effects.TakeControl)) for e in asked)
    assert (walk.craft.phase, walk.craft.authority) == (phase, before.authority)
    (raised,) = walk.of_kind(AlertRaised)
    assert (raised.topic, raised.level, raised.reason) == ("vehicle", "caution", FailsafeStopped("LOITER"))


@pytest.mark.parametrize("command", [commands.Hold(), commands.Return(), commands.Abort(), commands.Resume()])
def test_an_operator_takes_the_vehicle_from_its_failsafe_and_that_is_a_fact(command: commands.ForCraft) -> None:
    walk = CraftWalk().to("flying")
    walk.give(inputs.AuthorityHeard(FAILSAFE))
    asked = walk.order(command)
    first = next(k for k, effect in enumerate(asked) if isinstance(effect, VEHICLE))
    assert effects.TakeControl() in asked[:first]
    changed = walk.of_kind(AuthorityChanged)[-1]
    assert (changed.authority.who, changed.authority.taken_by, changed.by) == ("ours", None, "anna")
    assert not walk.topics


def test_the_pilot_in_control_is_never_commanded_not_even_by_hold_return_or_abort() -> None:
    for command in (commands.Hold(), commands.Return(), commands.Abort(), commands.Override(place=HOME)):
        walk = CraftWalk().to("manual")
        assert not sent(walk.order(command))
        assert walk.craft.phase == "manual"
    walk = CraftWalk().to("manual")
    walk.order(commands.Abort())
    assert walk.search.outcome == "aborted"
    assert walk.craft.engaged


def test_a_pilot_landing_ends_the_flight_and_what_was_to_be_watched_in_it() -> None:
    walk = CraftWalk().to("manual")
    walk.give(inputs.BatteryLow(BATTERY_VETO))
    walk.give(inputs.Landed())
    assert not walk.topics
    assert (walk.craft.phase, walk.craft.engaged, walk.search.outcome) == ("ground", False, "not_localized")
    assert walk.craft.phase_reason == Landed("manual")


def test_who_has_control_is_not_claimed_where_it_may_be_the_failsafe() -> None:
    for authority in (PILOT, PERHAPS_PILOT):
        walk = CraftWalk().to("flying")
        walk.give(inputs.AuthorityHeard(authority))
        (raised,) = walk.of_kind(AlertRaised)
        assert raised.reason == PilotFlies(authority.mode or "", authority.perhaps_failsafe)


def test_control_that_a_pilot_gives_back_is_a_fact_and_stays_the_pilots_until_an_operator_resumes() -> None:
    walk = CraftWalk().to("manual")
    assert walk.give(inputs.AuthorityHeard(GIVEN_BACK)) != ()
    assert walk.craft.authority.given_back
    assert walk.craft.taken_over
    assert walk.craft.phase == "manual"
    assert walk.give(inputs.AuthorityHeard(GIVEN_BACK)) == ()
    walk.order(commands.Resume())
    assert not walk.craft.taken_over
    assert effects.HoldVehicle() in walk.order(commands.Hold()), "an order right after the resume is carried out"


def test_a_failsafe_that_landed_or_gave_way_to_the_pilot_is_no_longer_said_to_fly() -> None:
    for after in (inputs.Landed(), inputs.AuthorityHeard(PILOT)):
        walk = CraftWalk().to("hold")
        walk.give(inputs.AuthorityHeard(FAILSAFE))
        walk.give(after)
        assert "vehicle" not in walk.topics
        assert walk.topics
    lost = CraftWalk().to("hold")
    lost.give(inputs.LinkDown("vehicle", LINK_LOST))
    lost.give(inputs.AuthorityHeard(PILOT))
    assert "vehicle" in lost.topics


def test_a_lost_console_holds_and_then_returns_by_timers() -> None:
    walk = CraftWalk().to("flying")
    asked = walk.give(inputs.LinkDown("console", LINK_LOST))
    timers = SPEC.timers
    assert effects.StartTimer("console_hold", timers.console_lost_hold_s) in asked
    assert effects.StartTimer("console_return", timers.console_lost_return_s) in asked
    walk.give(inputs.TimerExpired("console_hold"))
    assert walk.craft.phase == "hold"
    assert moves(walk.give(inputs.TimerExpired("console_return"))) == [effects.ReturnHome()]
    back = CraftWalk().to("flying")
    back.give(inputs.LinkDown("console", LINK_LOST))
    asked = back.give(inputs.LinkUp("console", 4.0))
    assert effects.CancelTimer("console_hold") in asked
    assert effects.CancelTimer("console_return") in asked
    assert back.craft.phase == "flying"


def test_without_a_console_the_failsafes_own_return_is_left_to_bring_the_vehicle_home() -> None:
    walk = CraftWalk().to("flying")
    walk.give(inputs.AuthorityHeard(FAILSAFE))
    assert not sent(walk.give(inputs.TimerExpired("console_return")))
    assert walk.craft.phase == "returning"
    walk.give(inputs.HomeReached())
    assert not sent(walk.give(inputs.TimerExpired("landing")))
    assert walk.craft.phase == "landing"


def test_without_a_console_the_timers_run_on_where_a_failsafe_counted_as_a_pilots_for_a_moment() -> None:
    """The failsafe may end in the air."""
    timers = SPEC.timers
    walk = CraftWalk().to("flying")
    walk.give(inputs.LinkDown("console", LINK_LOST))
    assert effects.CancelTimer("console_return") in walk.give(inputs.AuthorityHeard(PERHAPS_PILOT))
    asked = walk.give(inputs.AuthorityHeard(replace(FAILSAFE, cause="position")))
    assert walk.craft.phase == "hold"
    assert effects.StartTimer("console_return", timers.console_lost_return_s) in asked
    heard = CraftWalk().to("flying")
    heard.give(inputs.AuthorityHeard(PERHAPS_PILOT))
    asked = heard.give(inputs.AuthorityHeard(replace(FAILSAFE, cause="position")))
    assert not any(isinstance(effect, effects.StartTimer) for effect in asked)


def test_a_lost_vehicle_link_holds_and_on_return_the_hold_is_sent() -> None:
    walk = CraftWalk().to("flying")
    asked = walk.give(inputs.LinkDown("vehicle", LINK_LOST))
    assert walk.craft.phase == "hold"
    assert effects.CancelWork() in asked
    assert refusal(walk.order(commands.Resume())) == NoLink()
    assert effects.HoldVehicle() in walk.give(inputs.LinkUp("vehicle", 5.0))
    assert refusal(walk.order(commands.Resume())) is None


@pytest.mark.parametrize("ordered", [commands.Return(), inputs.TimerExpired("console_return")])
def test_a_way_home_ordered_over_a_lost_link_is_ordered_again_when_the_vehicle_is_heard(ordered: object) -> None:
    walk = CraftWalk().to("flying")
    walk.give(inputs.LinkDown("vehicle", LINK_LOST))
    if isinstance(ordered, commands.Return):
        walk.order(ordered)
    else:
        walk.give(ordered)  # type: ignore[arg-type]
    walk.give(inputs.WorkFailed("return", NO_ANSWER, in_air=True))
    assert walk.craft.phase == "returning"
    assert walk.last_alert.reason == OrderedAgainLater(NO_ANSWER)
    assert moves(walk.give(inputs.LinkUp("vehicle", 9.0))) == [effects.ReturnHome()]
    assert not walk.topics
    walk.give(inputs.WorkFailed("return", NO_ANSWER, in_air=True))
    assert walk.craft.phase == "returning"
    assert walk.last_alert.reason == NotDone("return", "return", NO_ANSWER, "return", 1.0)


def test_an_abort_over_a_lost_link_is_ordered_again_when_the_vehicle_is_heard_unless_it_was_held_since() -> None:
    for lost_first in (True, False):
        walk = CraftWalk().to("flying")
        steps = [
            lambda w: w.give(inputs.LinkDown("vehicle", LINK_LOST)),
            lambda w: w.order(commands.Abort()),
        ]
        for step in steps if lost_first else reversed(steps):
            step(walk)
        walk.give(inputs.WorkFailed("hold", NO_ANSWER, in_air=True))
        assert moves(walk.give(inputs.LinkUp("vehicle", 9.0))) == [effects.ReturnHome()]
        assert not walk.topics
        walk.give(inputs.LinkDown("vehicle", LINK_LOST))
        walk.order(commands.Hold())
        assert sent(walk.give(inputs.LinkUp("vehicle", 9.0))) == [effects.HoldVehicle()]


def test_a_fault_of_our_own_does_not_stop_the_way_home() -> None:
    for phase in HOMEWARD:
        for fault in (inputs.WorkFailed("hold", NO_ANSWER, in_air=True), inputs.Broke(BROKE)):
            walk = craft_in(phase)
            asked = walk.give(fault)
            assert walk.craft.phase == phase
            assert not any(isinstance(e, (*VEHICLE, effects.CancelWork)) for e in asked)
            assert walk.topics == ["failure"]


def test_a_fault_of_our_own_holds_what_flies_by_itself() -> None:
    for phase in AUTOMATIC:
        walk = craft_in(phase)
        assert sent(walk.give(inputs.Broke(BROKE))) == [effects.HoldVehicle()]
        assert walk.craft.phase == "hold"


def test_a_vehicle_that_has_lost_its_place_is_held_whatever_it_does_by_itself() -> None:
    for phase in AUTOMATIC:
        walk = craft_in(phase)
        assert sent(walk.give(inputs.LinkDown("gps", PlaceUnknown()))) == [effects.HoldVehicle()]
        assert (walk.craft.phase, walk.topics) == ("hold", ["gps"])
        assert walk.last_alert.reason == PlaceUnknown()
        walk.give(inputs.LinkUp("gps", 2.0))
        assert (walk.craft.phase, walk.topics) == ("hold", [])


def test_a_silent_receiver_holds_only_a_running_measurement() -> None:
    flying = CraftWalk().to("flying")
    flying.give(inputs.LinkDown("receiver", RECEIVER_SILENT))
    assert flying.craft.phase == "flying"
    measuring = CraftWalk().to("measuring")
    measuring.give(inputs.LinkDown("receiver", RECEIVER_SILENT))
    assert measuring.craft.phase == "hold"
    assert measuring.topics == ["receiver"]
    assert measuring.last_alert.reason == ReceiverTrouble(RECEIVER_SILENT)
    measuring.give(inputs.LinkUp("receiver", 9.0))
    assert not measuring.topics


def test_a_low_battery_brings_the_vehicle_home() -> None:
    for given_ in (
        inputs.BatteryLow(BATTERY_VETO),
        inputs.WorkVetoed((BATTERY_VETO,)),
        inputs.WorkVetoed((SILENT_BATTERY, BATTERY_VETO)),
    ):
        walk = CraftWalk().to("flying")
        assert moves(walk.give(given_)) == [effects.ReturnHome()]
        assert walk.craft.phase == "returning"


def test_the_alert_of_an_unknown_charge_is_cleared_when_it_is_reported_again() -> None:
    walk = CraftWalk().to("hold")
    walk.give(inputs.BatteryLow(SILENT_BATTERY))
    assert walk.topics == ["battery"]
    assert walk.last_alert.reason == SILENT_BATTERY
    walk.give(inputs.BatteryReported())
    assert not walk.topics


def test_a_vetoed_flight_holds_and_says_why() -> None:
    walk = CraftWalk().to("flying")
    asked = walk.give(inputs.WorkVetoed((VETO,)))
    assert walk.craft.phase == "hold"
    assert not moves(asked)
    assert walk.topics == ["safety"]
    assert walk.last_alert.reason == VETO


def test_a_failed_take_off_on_the_ground_ends_the_flight_and_in_the_air_holds() -> None:
    ground, air, unknown = (CraftWalk().to("taking_off") for _ in range(3))
    ground.give(inputs.WorkFailed("take_off", NO_TAKE_OFF, in_air=False))
    air.give(inputs.WorkFailed("take_off", NO_TAKE_OFF, in_air=True))
    unknown.give(inputs.WorkFailed("take_off", NO_TAKE_OFF, in_air=None))
    assert (ground.craft.phase, ground.craft.engaged, ground.search.outcome) == ("ground", False, "failed")
    assert ground.search.outcome_reason == NO_TAKE_OFF
    assert air.craft.phase == unknown.craft.phase == "hold"


def test_alerts_of_two_craft_are_told_apart_and_a_later_one_on_a_topic_takes_the_place_of_the_earlier() -> None:
    walks = [CraftWalk(craft_id=name) for name in ("craft-1", "craft-2")]
    for walk in walks:
        walk.to("manual")
        walk.give(inputs.BatteryLow(SILENT_BATTERY))
        walk.give(inputs.BatteryLow(BATTERY_VETO))
        assert [(a.topic, a.reason) for a in walk.craft.open_alerts if a.topic == "battery"] == [
            ("battery", BATTERY_VETO)
        ]
    ids = [{raised.alert_id for raised in walk.of_kind(AlertRaised)} for walk in walks]
    assert not ids[0] & ids[1]


@pytest.mark.parametrize("phase", sorted(HOMEWARD))
def test_a_failsafe_on_an_ordered_way_home_ends_alike_whichever_of_its_mode_and_its_name_is_heard_first(
    phase: Phase,
) -> None:
    for heard in ((NAMED_FAILSAFE,), (PERHAPS_PILOT, NAMED_FAILSAFE)):
        walk = craft_in(phase)
        for authority in heard:
            assert not sent(walk.give(inputs.AuthorityHeard(authority)))
        assert walk.craft.phase == phase
        assert walk.topics == ["vehicle"]
        assert walk.last_alert.reason == FailsafeFlies("battery")
        walk.give(inputs.Landed())
        assert (walk.craft.phase, walk.craft.engaged, walk.search.stage) == ("ground", False, "ended")


def test_a_pilot_of_whom_there_is_no_doubt_any_more_is_said_to_be_one() -> None:
    walk = craft_in("flying")
    walk.give(inputs.AuthorityHeard(PERHAPS_PILOT))
    walk.give(inputs.AuthorityHeard(replace(PERHAPS_PILOT, perhaps_failsafe=False)))
    assert walk.last_alert.reason == PilotFlies("RETURN", perhaps_failsafe=False)
    assert walk.topics == ["pilot"]
