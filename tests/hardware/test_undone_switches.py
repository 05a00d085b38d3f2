"""A pilot's switch that crossed our order, and was undone by it, is noticed and does not give control back to us."""

from __future__ import annotations

import pytest
from flown_craft import GUIDED, HOLD, POSCTL, RETURN, Craft, flying

from hardware.authority import GIVEN_BACK_S, OperatorTookControl, SticksTookOver, SwitchMoved


@pytest.mark.parametrize("order", [RETURN, GUIDED])
def test_a_switch_that_a_command_under_way_undid_is_not_given_back(order: int) -> None:
    craft = flying(HOLD)
    craft.commands(order)
    craft.hears(POSCTL)
    undone = craft.hears(order)
    assert (undone.who, undone.undone, undone.given_back) == ("pilot", True, False)
    craft.waits(GIVEN_BACK_S)
    assert craft.hears(order) == undone
    again = craft.hears(POSCTL)
    assert (again.who, again.undone) == ("pilot", False)
    craft.waits(GIVEN_BACK_S)
    assert craft.hears(HOLD).given_back


def test_sticks_that_a_command_under_way_undid_are_not_given_back_either() -> None:
    craft = flying(HOLD)
    craft.commands(GUIDED)
    craft.sees(SticksTookOver(craft.at_s))
    craft.hears(POSCTL)
    assert craft.hears(GUIDED).undone


def test_a_pilot_who_gives_back_at_once_was_undone_by_nobody() -> None:
    """The command before had long shown its mode."""
    craft = flying(HOLD)
    craft.hears(POSCTL)
    assert not craft.hears(HOLD).undone
    craft.waits(GIVEN_BACK_S)
    assert craft.hears(HOLD).given_back


def test_an_operator_may_take_what_was_undone() -> None:
    craft = flying(HOLD)
    craft.commands(GUIDED)
    craft.hears(POSCTL)
    craft.hears(GUIDED)
    assert (craft.sees(OperatorTookControl()).who, craft.now.undone) == ("ours", False)


def test_a_switch_that_an_order_undid_before_its_mode_was_told_is_known_by_its_movement() -> None:
    craft = flying()
    craft.commands(RETURN)
    craft.hears(RETURN)

    taken = craft.sees(SwitchMoved("RETURN", craft.at_s))

    assert (taken.who, taken.taken_by, taken.mode) == ("pilot", "mode", "RETURN")
    assert taken.undone
    assert not craft.hears(RETURN).given_back
    craft.waits(GIVEN_BACK_S)
    craft.hears(POSCTL)
    assert craft.hears(HOLD).given_back


def test_a_switch_moved_on_the_ground_or_while_nothing_is_commanded_takes_nothing() -> None:
    found = Craft()
    found.hears(HOLD)
    assert found.sees(SwitchMoved("HOLD", found.at_s)).taken_by is None
    ground = Craft()
    ground.on_ground(HOLD)
    ground.commands(HOLD)
    assert ground.sees(SwitchMoved("HOLD", ground.at_s)).taken_by is None
