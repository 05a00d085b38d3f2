"""Whose a way home is that nobody commanded, where the autopilot says that a failsafe of its own acts."""

from __future__ import annotations

import pytest
from flown_craft import GUIDED, HOLD, KINDS, LAND, NAMES, POSCTL, RETURN, Craft, flying

from hardware.authority import (
    ACTS_S,
    GIVEN_BACK_S,
    NAMED_S,
    Authority,
    FailsafeCause,
    FailsafeNamed,
    ModeHeard,
    OperatorTookControl,
    ServerRestarted,
    SticksTookOver,
    SwitchMoved,
)


def named(craft: Craft, cause: FailsafeCause = "battery", later_s: float = 0.0) -> Authority:
    craft.waits(later_s)
    return craft.sees(FailsafeNamed(cause, craft.at_s))


def says(craft: Craft, acts: bool, mode: int = RETURN, later_s: float = 0.5) -> Authority:
    """The heartbeat of an autopilot whose state tells who chose its mode."""
    craft.waits(later_s)
    return craft.sees(ModeHeard(mode, KINDS[mode], NAMES[mode], True, True, False, craft.at_s, acts))


@pytest.mark.parametrize("mode", [RETURN, LAND])
@pytest.mark.parametrize("first", ["name", "mode"])
def test_a_way_home_is_the_named_failsafes_whichever_is_heard_first(mode: int, first: str) -> None:
    craft = flying(GUIDED)
    if first == "name":
        named(craft)
        craft.hears(mode)
    else:
        craft.hears(mode)
        named(craft)
    now = craft.now
    assert (now.who, now.cause, now.taken_by, now.perhaps_failsafe) == ("failsafe", "battery", "mode", False)
    assert named(craft) == craft.now, "said again"
    craft.hears(LAND)
    landed = craft.on_ground(HOLD)
    assert (landed.who, landed.failsafe_landed) == ("nobody", True)


@pytest.mark.parametrize("first", ["name", "mode"])
def test_a_way_home_long_before_or_after_a_warning_is_the_pilots(first: str) -> None:
    craft = flying(GUIDED)
    if first == "name":
        named(craft)
        craft.waits(NAMED_S)
        craft.hears(RETURN)
    else:
        craft.hears(RETURN)
        named(craft, later_s=NAMED_S + 0.1)
    assert (craft.now.who, craft.now.cause, craft.now.perhaps_failsafe) == ("pilot", None, True)


def test_a_failsafe_that_only_warns_takes_nothing_and_leaves_every_other_mode_to_the_pilot() -> None:
    craft = flying(GUIDED)
    assert named(craft).who == "ours"
    assert craft.commands(HOLD).who == "ours"
    craft = flying(GUIDED)
    named(craft)
    assert craft.hears(POSCTL).who == "pilot"
    assert named(craft).who == "pilot"


def test_a_pilot_keeps_what_they_had_before_the_failsafe_was_named() -> None:
    craft = flying(GUIDED)
    craft.hears(POSCTL)
    named(craft)
    assert craft.hears(RETURN).who == "pilot"
    assert named(craft).who == "pilot"
    craft = flying(GUIDED)
    craft.sees(SticksTookOver(craft.at_s))
    craft.hears(RETURN)
    assert named(craft).who == "pilot"


def test_a_switch_that_moved_is_the_pilots_before_with_and_after_the_failsafes_name() -> None:
    before = flying(GUIDED)
    before.sees(SwitchMoved("RETURN", before.at_s))
    before.hears(RETURN)
    assert named(before).who == "pilot"
    between = flying(GUIDED)
    between.hears(RETURN)
    between.sees(SwitchMoved("RETURN", between.at_s))
    assert named(between).who == "pilot"
    after = flying(GUIDED)
    named(after)
    assert after.hears(RETURN).who == "failsafe"
    taken = after.sees(SwitchMoved("RETURN", after.at_s))
    assert (taken.who, taken.cause, taken.perhaps_failsafe) == ("pilot", None, False)
    assert named(after).who == "pilot"


@pytest.mark.parametrize("cause", ["transmitter", "silence"])
def test_the_channel_of_a_transmitter_that_is_lost_tells_of_no_pilot(cause: FailsafeCause) -> None:
    craft = flying(GUIDED)
    named(craft, cause)
    craft.hears(RETURN)
    assert craft.sees(SwitchMoved("RETURN", craft.at_s)).who == "failsafe"
    assert craft.hears(POSCTL).who == "pilot"


def test_an_operator_takes_the_vehicle_from_a_named_failsafe_and_the_next_failsafe_may_act_again() -> None:
    craft = flying(GUIDED)
    named(craft)
    craft.hears(RETURN)
    taken = craft.sees(OperatorTookControl())
    assert (taken.who, taken.cause, taken.named_at_s) == ("ours", None, None)
    craft.commands(HOLD)
    assert craft.hears(HOLD).who == "ours"
    named(craft, "position", later_s=5.0)
    second = craft.hears(LAND)
    assert (second.who, second.cause) == ("failsafe", "position")
    craft.sees(OperatorTookControl())
    craft.commands(HOLD)
    craft.hears(HOLD)
    craft.waits(2.0 * NAMED_S)
    assert craft.hears(RETURN).who == "pilot"


def test_the_cause_named_last_counts_and_one_that_is_not_known_replaces_none() -> None:
    craft = flying(GUIDED)
    craft.hears(RETURN, after_silence=True)
    assert craft.now.cause is None
    assert named(craft, "other").cause == "other"
    assert named(craft, "transmitter").cause == "transmitter"
    assert named(craft, "other").cause == "transmitter"
    assert named(craft, "battery").cause == "battery"


def test_after_a_failsafe_for_its_place_it_may_wait_again_by_itself_after_others_a_pilot_holds() -> None:
    craft = flying(HOLD)
    named(craft, "position")
    craft.hears(LAND)
    craft.waits(GIVEN_BACK_S)
    waits = craft.hears(HOLD)
    assert (waits.who, waits.given_back) == ("failsafe", True)
    craft = flying(HOLD)
    named(craft, "battery")
    craft.hears(LAND)
    assert craft.hears(HOLD).who == "pilot"


def test_who_stops_the_landing_of_an_autopilot_that_never_waits_again_by_itself_is_a_pilot() -> None:
    """ArduCopter lands for its place to the ground, even when that is known again: only a hand selects BRAKE."""
    craft = flying(HOLD)
    named(craft, "position")
    craft.hears(LAND)
    craft.waits(GIVEN_BACK_S)
    stopped = ModeHeard(HOLD, "waiting", "BRAKE", True, True, False, craft.at_s, waits_again=False)
    assert craft.sees(stopped).who == "pilot"


def test_an_undone_switch_stays_the_pilots() -> None:
    craft = flying(GUIDED)
    craft.commands(RETURN)
    craft.hears(LAND)
    assert craft.hears(RETURN).undone
    assert named(craft).who == "pilot"


def test_an_autopilot_whose_state_tells_has_the_last_word() -> None:
    lost_name = flying(HOLD)
    lost_name.hears(RETURN)
    told = says(lost_name, acts=True)
    assert (told.who, told.cause) == ("failsafe", "other")
    warned = flying(HOLD)
    named(warned)
    assert warned.hears(RETURN).who == "failsafe"
    pilots = says(warned, acts=False)
    assert (pilots.who, pilots.perhaps_failsafe, pilots.cause) == ("pilot", False, None)
    assert named(warned).who == "pilot"
    at_once = flying(HOLD)
    named(at_once)
    assert says(at_once, acts=False).who == "pilot"
    late = flying(HOLD)
    late.hears(RETURN)
    assert says(late, acts=True, mode=LAND, later_s=ACTS_S + 0.1).who == "pilot"


def test_a_failsafe_that_is_named_on_the_ground_is_nothing() -> None:
    craft = Craft()
    craft.on_ground(HOLD)
    before = craft.now
    assert named(craft) == before


def test_a_restart_keeps_the_cause_and_an_authority_stored_before_causes_were_kept_still_loads() -> None:
    craft = flying(GUIDED)
    named(craft, "fence")
    craft.hears(RETURN)
    assert craft.sees(ServerRestarted()).cause == "fence"
    old = Authority(who="pilot", taken_by="mode", taken_at_s=1.0, mode="RTL", perhaps_failsafe=True)
    assert (old.cause, old.named_at_s) == (None, None)


@pytest.mark.parametrize("cause", ["battery", "fence", "transmitter", "silence", "other"])
def test_who_selects_another_way_home_than_the_named_failsafe_flies_is_a_pilot(cause: FailsafeCause) -> None:
    """A pilot who lands at once on a switch without a known channel, or once their transmitter is heard again."""
    craft = flying(GUIDED)
    named(craft, cause)
    craft.hears(RETURN)
    craft.waits(10.0)
    landing = craft.hears(LAND)
    assert (landing.who, landing.perhaps_failsafe, landing.cause) == ("pilot", True, None)
    assert craft.hears(LAND).who == "pilot"


@pytest.mark.parametrize("first", ["name", "mode"])
def test_the_second_of_two_failsafes_that_are_named_flies_on(first: str) -> None:
    craft = flying(GUIDED)
    named(craft, "transmitter")
    craft.hears(RETURN)
    craft.waits(10.0)
    if first == "name":
        named(craft, "battery")
        craft.hears(LAND)
    else:
        craft.hears(LAND)
        named(craft, "battery")
    assert (craft.now.who, craft.now.cause, craft.now.mode) == ("failsafe", "battery", "LAND")


def test_the_state_alone_tells_that_a_failsafe_changes_its_way_home() -> None:
    craft = flying(HOLD)
    named(craft)
    craft.hears(RETURN)
    assert says(craft, acts=True, mode=LAND, later_s=10.0).who == "failsafe"
    craft.waits(10.0)
    craft.hears(RETURN)
    assert says(craft, acts=True).who == "failsafe"


def test_what_leaves_the_waiting_of_a_vehicle_that_knows_its_place_again_is_a_pilot() -> None:
    craft = flying(HOLD)
    named(craft, "position")
    craft.hears(LAND)
    craft.waits(GIVEN_BACK_S)
    craft.hears(HOLD)
    craft.waits(10.0)
    assert craft.hears(LAND).who == "pilot"


def test_who_takes_a_way_home_from_a_failsafe_that_only_the_state_told_is_a_pilot() -> None:
    """It began while the link was silent, so that its name was not heard."""
    for mode in (RETURN, LAND):
        craft = flying(HOLD)
        assert craft.hears(RETURN, after_silence=True).cause is None
        assert says(craft, acts=True).cause == "silence"
        craft.waits(60.0)
        assert says(craft, acts=False, mode=mode).who == "pilot"
    landing = flying(HOLD)
    landing.hears(RETURN, after_silence=True)
    says(landing, acts=True)
    landing.hears(LAND)
    assert says(landing, acts=True, mode=LAND).who == "failsafe"


def test_a_return_of_our_own_that_a_restarted_server_knows_nothing_of_stays_no_pilots() -> None:
    craft = flying(HOLD)
    craft.sees(ServerRestarted())
    assert craft.hears(RETURN, after_silence=True).who == "failsafe"
    assert says(craft, acts=False, later_s=60.0).who == "failsafe"


@pytest.mark.parametrize("acts", [False, None])
def test_who_leaves_the_waiting_after_a_failsafe_that_named_nothing_is_a_pilot(acts: bool | None) -> None:
    """The link was silent for a moment when it was stopped, so that nobody knows by whom."""
    craft = flying(HOLD)
    craft.hears(RETURN, after_silence=True)
    assert craft.hears(HOLD, after_silence=True).given_back
    craft.waits(60.0)
    craft.hears(RETURN)
    told = craft.sees(ModeHeard(RETURN, "return", "RETURN", True, True, False, craft.at_s + 1.0, acts))
    assert (told.who, told.perhaps_failsafe) == ("pilot", acts is None)
    again = flying(HOLD)
    again.hears(RETURN, after_silence=True)
    again.hears(HOLD, after_silence=True)
    assert again.hears(RETURN, after_silence=True).who == "failsafe"
    again.hears(HOLD, after_silence=True)
    again.waits(60.0)
    named(again, "battery")
    assert again.hears(RETURN).who == "failsafe"
