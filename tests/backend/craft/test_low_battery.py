"""A battery that runs low in hold belongs to somebody: a countdown that an operator may stop once."""

from __future__ import annotations

import pytest
from craft_walk import CraftWalk, craft_in, moves, refusal
from facts import BATTERY_VETO, FAILSAFE, OURS

from backend import commands
from backend.craft import effects, inputs
from backend.craft.low_battery import COUNTDOWN_S
from backend.events import BatteryCountdownStarted, BatteryCountdownStopped, LandOrdered, ReturnOrdered, ServerRestarted
from backend.reasons.refusals import NoCountdown

LOW, LAST, LAND = (inputs.BatteryLow(BATTERY_VETO, stage) for stage in ("return", "last", "land"))
EXPIRED = inputs.TimerExpired("battery_return")


def counting() -> CraftWalk:
    walk = craft_in("hold")
    asked = walk.give(LOW)
    assert effects.StartTimer("battery_return", COUNTDOWN_S) in asked
    assert moves(asked) == []
    assert walk.of_kind(BatteryCountdownStarted)[-1].seconds == COUNTDOWN_S
    return walk


def test_nobody_stops_it_and_the_craft_returns_because_of_its_battery() -> None:
    walk = counting()
    assert moves(walk.give(EXPIRED)) == [effects.ReturnHome()]
    assert walk.of_kind(ReturnOrdered)[-1].reason == BATTERY_VETO
    assert walk.craft.return_reason == BATTERY_VETO
    assert "battery" in walk.topics


def test_an_operator_stops_it_once_and_the_alert_stays() -> None:
    walk = counting()
    asked = walk.order(commands.KeepHolding())
    assert effects.CancelTimer("battery_return") in asked
    assert walk.of_kind(BatteryCountdownStopped)[-1].by == "anna"
    assert moves(walk.give(EXPIRED)) == []
    assert moves(walk.give(LOW)) == []
    assert not walk.craft.counting_down
    assert "battery" in walk.topics
    assert isinstance(refusal(walk.order(commands.KeepHolding())), NoCountdown)


@pytest.mark.parametrize(("low", "sent"), [(LAST, effects.ReturnHome()), (LAND, effects.Land())])
def test_a_stopped_countdown_stops_nothing_of_what_comes_lower(low: inputs.BatteryLow, sent: effects.Motion) -> None:
    walk = counting()
    walk.order(commands.KeepHolding())
    assert moves(walk.give(low)) == [sent]


def test_a_battery_that_suffices_again_ends_it_and_may_count_down_again() -> None:
    walk = counting()
    assert effects.CancelTimer("battery_return") in walk.give(inputs.BatteryReported())
    assert moves(walk.give(EXPIRED)) == []
    assert effects.StartTimer("battery_return", COUNTDOWN_S) in walk.give(LOW)


def test_a_resume_ends_it() -> None:
    walk = counting()
    walk.order(commands.Resume())
    assert not walk.craft.counting_down
    walk.order(commands.Hold())
    assert moves(walk.give(EXPIRED)) == []


def test_after_a_restart_it_begins_anew_when_the_battery_is_still_low() -> None:
    walk = counting()
    walk.fold(ServerRestarted())
    walk.give(inputs.Restarted(OURS))
    assert not walk.craft.counting_down
    assert effects.StartTimer("battery_return", COUNTDOWN_S) in walk.give(LOW)


def test_what_the_failsafe_brings_home_is_left_alone() -> None:
    walk = counting()
    walk.give(inputs.AuthorityHeard(FAILSAFE))
    assert moves(walk.give(EXPIRED)) == []
    assert not walk.craft.counting_down
    assert moves(walk.give(LAST)) == []


def test_on_the_way_home_a_battery_that_does_not_reach_it_lands_here() -> None:
    walk = craft_in("returning")
    assert moves(walk.give(LAST)) == []
    assert moves(walk.give(LAND)) == [effects.Land()]
    assert walk.craft.phase == "landing"
    told = walk.of_kind(LandOrdered)[-1]
    assert (told.by, told.reason) == (None, BATTERY_VETO), "a page tries no older order over it"
