from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from hardware.autopilot.control import ControlLatch

HOLD, GUIDED, POSCTL, RETURN = 1, 2, 3, 4


def latch() -> ControlLatch:
    return ControlLatch(frozenset({HOLD, GUIDED}), lambda mode: f"mode {mode}")


def flying(control: ControlLatch, mode: int) -> str | None:
    return control.observe(mode, armed=True, in_air=True)


def test_the_mode_before_a_command_is_tolerated_until_the_commanded_one_was_seen() -> None:
    control = latch()
    flying(control, HOLD)
    control.command(frozenset({GUIDED}))

    assert flying(control, HOLD) is None
    assert flying(control, GUIDED) is None
    assert control.controller == "crossfix"
    assert flying(control, HOLD) is not None  # now it is nobody's command
    assert control.controller == "pilot"


def test_the_mode_of_our_last_command_may_show_after_the_next_was_sent() -> None:
    control = latch()
    control.observe(HOLD, armed=False, in_air=False)
    control.command(frozenset({GUIDED, HOLD}))
    control.observe(HOLD, armed=True, in_air=False)
    control.command(frozenset({RETURN}))
    control.command(frozenset({RETURN}))  # sent again

    assert flying(control, GUIDED) is None
    assert flying(control, RETURN) is None
    assert flying(control, GUIDED) is not None


def test_a_mode_that_was_there_before_is_no_sight_of_a_command_that_is_not_acknowledged() -> None:
    control = latch()
    control.observe(HOLD, armed=False, in_air=False)
    control.command(frozenset({GUIDED, HOLD}))
    control.command(frozenset({HOLD}))
    assert flying(control, HOLD) is None
    assert flying(control, GUIDED) is None
    control.acknowledged()
    assert flying(control, HOLD) is None
    assert flying(control, GUIDED) is not None


def test_a_pilot_between_command_and_its_mode_latches() -> None:
    control = latch()
    flying(control, HOLD)
    control.command(frozenset({GUIDED}))

    assert "mode 3" in (flying(control, POSCTL) or "")
    assert flying(control, GUIDED) is None  # the latch is closed already
    assert control.reason is not None


@given(st.lists(st.tuples(st.integers(0, 9), st.booleans(), st.booleans())), st.lists(st.integers(0, 9)))
def test_nothing_but_release_opens_the_latch(seen: list[tuple[int, bool, bool]], commanded: list[int]) -> None:
    control = latch()
    control.latch("the pilot moved the sticks")

    for mode, armed, in_air in seen:
        control.observe(mode, armed, in_air)
    for mode in commanded:
        control.command(frozenset({mode}))

    assert control.reason == "the pilot moved the sticks"
    control.release()
    assert control.reason is None


def test_after_release_the_mode_of_that_moment_is_accepted_and_another_latches_again() -> None:
    control = latch()
    control.command(frozenset({GUIDED}))
    flying(control, GUIDED)
    flying(control, POSCTL)
    control.release()

    assert flying(control, POSCTL) is None
    assert flying(control, RETURN) is not None


def test_it_is_held_until_an_airborne_vehicle_waits_for_orders_again() -> None:
    control = latch()
    control.command(frozenset({GUIDED}))
    flying(control, GUIDED)
    assert not control.held
    flying(control, POSCTL)
    assert control.held
    flying(control, RETURN)
    assert control.held
    flying(control, HOLD)
    assert not control.held
    assert control.reason is not None
    flying(control, POSCTL)
    assert control.held
    control.observe(POSCTL, armed=False, in_air=False)
    assert not control.held


def test_a_vehicle_found_in_the_air_is_nobodys_while_it_waits_and_the_pilots_when_it_does_not() -> None:
    waiting, flown = latch(), latch()

    assert flying(waiting, HOLD) is None
    assert waiting.controller == "nobody"
    assert flying(flown, POSCTL) is not None


def test_landing_ends_the_flight_and_the_autopilots_waiting_mode_on_the_ground_is_no_pilot() -> None:
    control = latch()
    control.command(frozenset({RETURN}))
    flying(control, RETURN)

    assert control.observe(HOLD, armed=True, in_air=False) is None
    assert control.observe(HOLD, armed=False, in_air=False) is None
    assert control.controller == "nobody"
    assert control.observe(POSCTL, armed=False, in_air=False) is None  # on the ground anybody may select modes


def test_a_late_word_of_being_disarmed_does_not_forget_the_take_off_command() -> None:
    control = latch()
    control.observe(HOLD, armed=False, in_air=False)
    control.command(frozenset({GUIDED}))
    control.observe(HOLD, armed=False, in_air=False)
    control.observe(GUIDED, armed=True, in_air=False)

    assert control.controller == "crossfix"
    assert flying(control, POSCTL) is not None


def test_a_take_off_that_came_to_nothing_leaves_the_modes_on_the_ground_to_anybody() -> None:
    control = latch()
    control.observe(HOLD, armed=False, in_air=False)
    control.command(frozenset({GUIDED}))
    control.stand_down()

    assert control.observe(POSCTL, armed=False, in_air=False) is None
    assert control.controller == "nobody"


def test_a_mode_selected_on_the_ground_during_our_take_off_latches() -> None:
    control = latch()
    control.observe(HOLD, armed=False, in_air=False)
    control.command(frozenset({GUIDED}))

    assert control.observe(POSCTL, armed=False, in_air=False) is not None
    control.release()
    assert control.observe(HOLD, armed=False, in_air=False) is None


def test_after_the_landing_nobody_has_control_though_only_an_operator_opens_the_latch() -> None:
    control = latch()
    flying(control, RETURN)
    assert control.controller == "pilot"
    control.observe(HOLD, armed=True, in_air=False)
    assert control.controller == "pilot"
    control.observe(HOLD, armed=False, in_air=False)
    assert control.controller == "nobody"
    assert control.reason is not None
    control.observe(POSCTL, armed=True, in_air=False)
    assert control.controller == "pilot"


def test_who_selects_a_mode_on_the_ground_during_a_later_take_off_is_a_pilot() -> None:
    control = latch()
    flying(control, POSCTL)
    control.observe(POSCTL, armed=False, in_air=False)
    control.release()
    control.command(frozenset({GUIDED}))
    control.observe(RETURN, armed=False, in_air=False)
    assert control.controller == "pilot"
