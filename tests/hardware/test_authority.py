"""Who flies, rule by rule. What an order undid: test_undone_switches.py. Every state: test_authority_sweep.py."""

from __future__ import annotations

import pytest
from flown_craft import GUIDED, HOLD, KINDS, LAND, POSCTL, RETURN, Craft, flying

from hardware.authority import (
    GIVEN_BACK_S,
    HOMEWARD,
    CommandAcknowledged,
    FlightEnded,
    OperatorTookControl,
    ServerRestarted,
    SticksTookOver,
)


def test_the_mode_before_a_command_is_tolerated_until_the_commanded_one_was_seen() -> None:
    craft = flying(HOLD)
    craft.commands(GUIDED)
    assert craft.hears(HOLD).who == "ours"
    assert craft.hears(GUIDED).who == "ours"
    assert craft.hears(HOLD).who == "pilot"


def test_the_mode_of_our_last_command_may_show_after_the_next_was_sent() -> None:
    craft = Craft()
    craft.on_ground(HOLD)
    craft.commands(GUIDED, HOLD)
    craft.on_ground(HOLD, armed=True)
    craft.commands(RETURN)
    craft.commands(RETURN)  # sent again
    assert craft.hears(GUIDED).who == "ours"
    assert craft.hears(RETURN).who == "ours"
    assert craft.hears(GUIDED).who == "pilot"


def test_a_mode_that_was_there_before_proves_nothing_until_the_command_is_acknowledged() -> None:
    craft = Craft()
    craft.on_ground(HOLD)
    craft.commands(GUIDED, HOLD)
    craft.commands(HOLD)
    assert craft.hears(HOLD).who == "ours"
    assert craft.hears(GUIDED).who == "ours"
    craft.sees(CommandAcknowledged())
    assert craft.hears(HOLD).who == "ours"
    assert craft.hears(GUIDED).who == "pilot"


def test_a_pilot_between_a_command_and_its_mode_takes_over_for_good() -> None:
    craft = flying(HOLD)
    craft.commands(GUIDED)
    taken = craft.hears(POSCTL)
    assert (taken.who, taken.taken_by, taken.mode) == ("pilot", "mode", "POSCTL")
    assert craft.hears(GUIDED).who == "pilot"
    assert craft.commands(GUIDED).who == "pilot"


def test_after_the_operators_deed_the_mode_of_that_moment_is_accepted_and_another_is_a_pilots_again() -> None:
    craft = flying(GUIDED)
    craft.hears(POSCTL)
    assert craft.sees(OperatorTookControl()).who == "ours"
    assert craft.hears(POSCTL).who == "ours"
    assert craft.hears(RETURN).who == "pilot"


def test_the_operators_deed_changes_nothing_while_nobody_else_has_control() -> None:
    for craft in (Craft(), flying(GUIDED)):
        before = craft.now
        assert craft.sees(OperatorTookControl()) == before


def test_it_is_given_back_when_the_flying_vehicle_waits_for_commands_again() -> None:
    craft = flying(GUIDED)
    assert not craft.hears(POSCTL).given_back
    craft.waits(GIVEN_BACK_S)
    assert not craft.hears(RETURN).given_back
    assert craft.hears(HOLD).given_back
    assert craft.now.who == "pilot"
    assert not craft.hears(POSCTL).given_back
    assert craft.on_ground(POSCTL).given_back


def test_the_mode_right_after_the_sticks_gives_nothing_back() -> None:
    """PX4 reports the sticks before it reports the mode."""
    craft = flying(HOLD)
    taken = craft.sees(SticksTookOver(craft.at_s))
    assert (taken.who, taken.taken_by, taken.mode, taken.perhaps_failsafe) == ("pilot", "sticks", None, False)
    assert not craft.hears(HOLD).given_back
    craft.waits(GIVEN_BACK_S)
    assert craft.hears(HOLD).given_back
    assert not craft.sees(SticksTookOver(craft.at_s)).given_back


def test_sticks_moved_on_the_ground_take_nothing() -> None:
    craft = Craft()
    craft.on_ground(HOLD)
    assert craft.sees(SticksTookOver(craft.at_s)).who == "nobody"


def test_a_vehicle_found_in_the_air_is_nobodys_while_it_waits_and_the_pilots_when_it_does_not() -> None:
    assert Craft().hears(HOLD).who == "nobody"
    found = Craft().hears(POSCTL)
    assert (found.who, found.perhaps_failsafe) == ("pilot", False)
    found = Craft().hears(RETURN)
    assert (found.who, found.perhaps_failsafe) == ("pilot", True)


def test_landing_ends_the_flight_and_the_autopilots_waiting_mode_on_the_ground_is_no_pilots() -> None:
    craft = flying(RETURN)
    assert craft.on_ground(HOLD, armed=True).who == "ours"
    assert craft.on_ground(HOLD).who == "nobody"
    assert craft.on_ground(POSCTL).who == "nobody"


def test_a_late_report_of_being_disarmed_does_not_forget_the_take_off_command() -> None:
    craft = Craft()
    craft.on_ground(HOLD)
    craft.commands(GUIDED)
    craft.on_ground(HOLD)
    assert craft.on_ground(GUIDED, armed=True).who == "ours"
    assert craft.hears(POSCTL).who == "pilot"


def test_a_take_off_that_came_to_nothing_leaves_the_modes_on_the_ground_to_anybody() -> None:
    craft = Craft()
    craft.on_ground(HOLD)
    craft.commands(GUIDED)
    craft.sees(FlightEnded())
    assert craft.on_ground(POSCTL).who == "nobody"


def test_a_mode_selected_on_the_ground_during_our_take_off_is_a_pilots() -> None:
    craft = Craft()
    craft.on_ground(HOLD)
    craft.commands(GUIDED)
    taken = craft.on_ground(POSCTL)
    assert (taken.who, taken.given_back) == ("pilot", True)
    craft.sees(OperatorTookControl())
    assert craft.on_ground(HOLD).who == "nobody"
    craft.commands(GUIDED)
    assert craft.on_ground(RETURN).who == "pilot"


def test_after_its_landing_it_is_nobodys_though_only_an_operator_lets_commands_pass_again() -> None:
    craft = Craft()
    craft.hears(RETURN)
    assert craft.on_ground(HOLD, armed=True).who == "pilot"
    landed = craft.on_ground(HOLD)
    assert (landed.who, landed.given_back, landed.mode) == ("nobody", True, "RETURN")
    assert craft.commands(GUIDED).who == "nobody"
    assert craft.on_ground(POSCTL, armed=True).who == "pilot"


def test_a_return_begun_in_a_silence_is_the_failsafes_one_seen_to_begin_may_be_the_pilots() -> None:
    found = flying(HOLD).hears(RETURN, after_silence=True)
    assert (found.who, found.taken_by, found.mode, found.perhaps_failsafe) == ("failsafe", "mode", "RETURN", False)
    seen = flying(HOLD).hears(RETURN)
    assert (seen.who, seen.perhaps_failsafe) == ("pilot", True)
    assert flying(HOLD).hears(POSCTL, after_silence=True).who == "pilot"


def test_a_doubt_about_the_failsafe_ends_with_the_first_mode_that_only_a_pilot_selects() -> None:
    craft = Craft()
    craft.hears(RETURN)
    assert craft.hears(LAND).perhaps_failsafe
    craft.waits(GIVEN_BACK_S)
    held = craft.hears(HOLD)  # PX4 goes there by itself once it knows its place again
    assert (held.given_back, held.perhaps_failsafe) == (True, True)
    assert not craft.hears(POSCTL).perhaps_failsafe
    assert not craft.hears(RETURN).perhaps_failsafe


def test_a_return_in_a_silence_while_the_pilot_had_control_stays_the_pilots() -> None:
    craft = flying(HOLD)
    craft.hears(POSCTL)
    assert craft.hears(RETURN, after_silence=True).who == "pilot"


def failsafe_flying() -> Craft:
    craft = flying(HOLD)
    craft.hears(RETURN, after_silence=True)
    return craft


def test_the_failsafe_lands_after_its_return_and_the_mode_after_its_landing_is_no_pilots() -> None:
    craft = failsafe_flying()
    landing = craft.hears(LAND)
    assert (landing.who, landing.mode) == ("failsafe", "LAND")
    assert craft.on_ground(HOLD, armed=True).who == "failsafe"
    landed = craft.on_ground(HOLD)
    assert (landed.who, landed.failsafe_landed) == ("nobody", True)
    assert craft.on_ground(HOLD).failsafe_landed
    armed_by_hand = craft.hears(POSCTL)
    assert (armed_by_hand.who, armed_by_hand.failsafe_landed) == ("pilot", False)


def test_a_failsafes_landing_that_a_pilot_took_over_is_the_pilots() -> None:
    craft = failsafe_flying()
    craft.hears(POSCTL)
    assert not craft.on_ground(HOLD).failsafe_landed


def test_who_lifts_off_again_in_a_mode_chosen_on_the_ground_before_it_disarmed_is_a_pilot() -> None:
    craft = failsafe_flying()
    craft.hears(LAND)
    assert craft.on_ground(POSCTL, armed=True).who == "failsafe"
    assert craft.hears(POSCTL).who == "pilot"


def test_an_operator_who_takes_control_forgets_that_the_failsafe_landed_it() -> None:
    craft = failsafe_flying()
    craft.on_ground(HOLD)
    assert not craft.sees(OperatorTookControl()).failsafe_landed


def test_a_failsafe_stopped_by_an_earlier_command_is_no_pilot_but_a_later_stop_is() -> None:
    craft = failsafe_flying()
    stopped = craft.hears(HOLD, after_silence=True)
    assert (stopped.who, stopped.mode, stopped.given_back) == ("failsafe", "HOLD", True)
    assert craft.hears(HOLD) == stopped
    assert craft.commands(HOLD) == stopped
    assert failsafe_flying().hears(HOLD).who == "pilot"


def test_who_leaves_the_failsafes_way_home_for_another_mode_or_by_the_sticks_is_a_pilot() -> None:
    for craft in (failsafe_flying(), failsafe_flying()):
        assert craft.hears(POSCTL, after_silence=True).who == "pilot"
    assert failsafe_flying().sees(SticksTookOver(0.0)).who == "pilot"


def test_an_operator_takes_the_vehicle_from_its_failsafe() -> None:
    craft = failsafe_flying()
    assert craft.sees(OperatorTookControl()).who == "ours"
    craft.commands(HOLD)
    assert craft.hears(RETURN).who == "ours"
    assert craft.hears(HOLD).who == "ours"
    assert craft.hears(RETURN).who == "pilot"


def test_after_a_silence_a_waiting_mode_is_not_judged_before_arming_is_known_any_other_is() -> None:
    """An autopilot that landed unheard goes to its waiting mode by itself."""
    craft = flying(RETURN)
    before = craft.now
    assert craft.hears(HOLD, armed=None) == before
    assert craft.on_ground(HOLD).who == "nobody"
    assert flying(RETURN).hears(POSCTL, armed=None).who == "pilot"
    craft = flying(RETURN)
    craft.hears(HOLD, armed=None)
    assert craft.hears(HOLD).who == "pilot"


def test_after_a_restart_our_own_return_is_ours_and_the_failsafes_is_not_told_as_a_pilots() -> None:
    craft = flying(RETURN)
    before = craft.now
    craft.sees(ServerRestarted())
    assert craft.hears(RETURN, after_silence=True) == before
    assert before.homeward
    craft = flying(HOLD)
    craft.sees(ServerRestarted())
    assert craft.hears(RETURN, after_silence=True).who == "failsafe"


def test_a_pilot_who_had_control_before_a_restart_has_it_after() -> None:
    craft = flying(HOLD)
    craft.hears(POSCTL)
    before = craft.now
    craft.sees(ServerRestarted())
    assert craft.hears(POSCTL, after_silence=True) == before
    craft.waits(GIVEN_BACK_S)
    assert (craft.hears(HOLD).who, craft.now.given_back) == ("pilot", True)


def test_the_mode_before_a_command_is_a_pilots_once_the_server_was_away() -> None:
    """It stood in POSCTL when its take-off was commanded; found there in the air, a pilot flies."""
    craft = Craft()
    craft.on_ground(POSCTL)
    craft.commands(GUIDED)
    craft.sees(ServerRestarted())
    assert craft.hears(POSCTL, after_silence=True).who == "pilot"


def test_a_restart_just_after_a_command_takes_the_waiting_vehicle_for_nobodys() -> None:
    """The command may have been sent and not yet recorded."""
    craft = flying(GUIDED)
    craft.sees(ServerRestarted())
    assert craft.hears(HOLD, after_silence=True).who == "nobody"
    assert craft.commands(HOLD).who == "ours"


@pytest.mark.parametrize("mode", sorted(KINDS))
def test_the_way_home_is_known_whoever_began_it(mode: int) -> None:
    assert flying(mode).now.homeward == (KINDS[mode] in HOMEWARD)
