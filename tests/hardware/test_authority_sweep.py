"""The promises about who flies, in every state that can be reached, for everything that can be seen there."""

from __future__ import annotations

from functools import cache
from itertools import product

from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter

from hardware.authority import (
    GIVEN_BACK_S,
    HOMEWARD,
    NAMED_S,
    Authority,
    CommandAcknowledged,
    CommandSent,
    FailsafeNamed,
    FlightEnded,
    ModeHeard,
    ModeKind,
    OperatorTookControl,
    Seen,
    ServerRestarted,
    SticksTookOver,
    SwitchMoved,
    authority_after,
)

HOLD, GUIDED, POSCTL, RETURN, LAND = 1, 2, 3, 4, 5
KINDS: dict[int, ModeKind] = {HOLD: "waiting", GUIDED: "waiting", POSCTL: "other", RETURN: "return", LAND: "land"}
EARLY_S, LATE_S = 100.0, 100.0 + GIVEN_BACK_S
BOTH = (False, True)

MODES = tuple(
    ModeHeard(mode, kind, f"mode {mode}", armed, in_air, after_silence, LATE_S)
    for (mode, kind), armed, in_air, after_silence in product(KINDS.items(), (None, *BOTH), BOTH, BOTH)
)
ACTING = tuple(
    ModeHeard(mode, KINDS[mode], f"mode {mode}", True, in_air, after_silence, LATE_S, acts)
    for mode, in_air, after_silence, acts in product((RETURN,), BOTH, BOTH, BOTH)
)
"""Of an autopilot that says with its mode whether a failsafe has chosen it."""
NAMED = (
    FailsafeNamed("position", LATE_S),
    FailsafeNamed("transmitter", LATE_S + NAMED_S),
    FailsafeNamed("battery", LATE_S + 2.0 * NAMED_S),
)
DEEDS: tuple[Seen, ...] = (
    *(CommandSent(frozenset(modes)) for modes in ({HOLD}, {HOLD, GUIDED}, {RETURN, LAND})),
    CommandAcknowledged(),
    SticksTookOver(EARLY_S),
    SticksTookOver(LATE_S),
    SwitchMoved("HOLD", LATE_S),
    *NAMED,
    FlightEnded(),
    OperatorTookControl(),
    ServerRestarted(),
)
ALL: tuple[Seen, ...] = (*MODES, *ACTING, *DEEDS)


@cache
def reachable() -> frozenset[Authority]:
    found, ahead = {Authority()}, [Authority()]
    while ahead:
        here = ahead.pop()
        for seen in ALL:
            after = authority_after(here, seen)
            if after not in found:
                found.add(after)
                ahead.append(after)
    return frozenset(found)


@cache
def steps() -> tuple[tuple[Authority, Seen, Authority], ...]:
    return tuple((before, seen, authority_after(before, seen)) for before in reachable() for seen in ALL)


def test_the_sweep_reaches_every_kind_of_state() -> None:
    assert {a.who for a in reachable()} == {"ours", "pilot", "failsafe", "nobody"}
    assert {a.taken_by for a in reachable()} == {None, "mode", "sticks"}
    for name in ("given_back", "perhaps_failsafe", "failsafe_landed", "undone", "armed", "restarted"):
        assert {getattr(a, name) for a in reachable()} == {False, True}, name


def test_it_is_ours_only_with_a_command_and_while_nobody_took_it() -> None:
    """A command is sent only while it is ours: no state lets one pass that somebody else took."""
    for a in reachable():
        assert (a.who == "ours") == bool(a.commanded)
        assert a.who != "ours" or a.taken_by is None
        assert a.who not in ("pilot", "failsafe") or a.taken_by is not None
        assert a.taken_by is not None or not (a.given_back or a.perhaps_failsafe or a.mode or a.taken_at_s or a.undone)
        assert not (a.undone and a.given_back)
        assert not a.perhaps_failsafe or a.taken_by == "mode"
        assert not a.failsafe_landed or (a.who, a.taken_by, a.armed) == ("nobody", "mode", False)


def test_what_somebody_else_took_comes_back_by_the_operators_deed_alone() -> None:
    for before, seen, after in steps():
        if before.taken_by is not None and not isinstance(seen, OperatorTookControl):
            assert after.taken_by is not None, (before, seen)
            assert after.who != "ours", (before, seen)
        if before.who != "ours" and after.who == "ours":
            assert isinstance(seen, CommandSent | OperatorTookControl), (before, seen)


def test_in_flight_every_mode_that_no_command_explains_is_somebody_elses() -> None:
    for before, seen, after in steps():
        if isinstance(seen, ModeHeard) and seen.in_air and seen.armed and before.who == "ours":
            explained = seen.mode in (*before.commanded, *before.tolerated)
            forgiven = before.restarted and seen.kind == "waiting"
            assert explained or forgiven or after.taken_by == "mode", (before, seen)


def test_what_begins_after_a_silence_on_the_way_home_is_never_told_as_a_pilots() -> None:
    for before, seen, after in steps():
        if isinstance(seen, ModeHeard) and seen.kind in HOMEWARD and seen.after_silence:
            assert before.taken_by is not None or after.who != "pilot", (before, seen)
            assert before.who != "failsafe" or after.who != "pilot", (before, seen)


def test_the_sticks_are_a_pilots_and_only_the_autopilot_ends_a_doubt_about_whose_a_way_home_is() -> None:
    for before, seen, after in steps():
        if isinstance(seen, SticksTookOver) and before.armed:
            assert (after.who, after.perhaps_failsafe, after.given_back) == ("pilot", False, False)
        if (before.who, after.who) == ("pilot", "failsafe"):
            named = isinstance(seen, FailsafeNamed) and seen.at_s <= LATE_S + NAMED_S
            assert named or (isinstance(seen, ModeHeard) and seen.acts), (before, seen)
            assert (before.perhaps_failsafe, before.taken_by) == (True, "mode"), (before, seen)
            assert not named or not before.undone, (before, seen)
            assert (after.homeward, after.armed) == (True, True), (before, seen)
            assert after.cause is not None, (before, seen)


def test_a_switch_that_moved_leaves_no_doubt_but_where_its_transmitter_is_lost() -> None:
    for before, seen, after in steps():
        if isinstance(seen, SwitchMoved) and before.armed:
            assert not after.perhaps_failsafe, (before, seen)
            heard = before.cause not in (None, "silence", "transmitter")
            assert before.who != "failsafe" or (after.who == "pilot") == heard, (before, seen)


def test_a_way_home_that_a_named_failsafe_did_not_choose_is_the_pilots() -> None:
    """Where the autopilot says so; a link that was silent has its own rule."""
    for before, seen, after in steps():
        if isinstance(seen, ModeHeard) and seen.acts is False and seen.in_air and not seen.after_silence:
            assert after.who != "failsafe" or after.cause is None, (before, seen)
            assert not after.perhaps_failsafe, (before, seen)


def test_control_is_given_back_only_when_the_vehicle_waits_or_stands() -> None:
    for before, seen, after in steps():
        if after.given_back and not before.given_back:
            assert isinstance(seen, ModeHeard), (before, seen)
            assert seen.kind == "waiting" or not after.armed, (before, seen)


def test_the_same_report_again_changes_nothing() -> None:
    """Ten reports a second make no ten facts."""
    for _, seen, after in steps():
        if isinstance(seen, ModeHeard | FailsafeNamed):
            assert authority_after(after, seen) == after, (after, seen)


def test_a_restart_in_between_changes_no_answer_but_forgives_a_waiting_mode_and_no_other() -> None:
    for before in reachable():
        restored = authority_after(authority_after(before, ServerRestarted()), ServerRestarted())
        for seen in MODES:
            live, after = authority_after(before, seen), authority_after(restored, seen)
            forgiven = (after.who, after.taken_by, live.who) == ("nobody", None, "pilot") and seen.kind == "waiting"
            unjudged = seen.armed is None and seen.kind == "waiting"
            assert after == live or forgiven or unjudged or before.tolerated, (before, seen)
            earlier = seen.mode not in before.commanded and seen.kind != "waiting" and seen.in_air and seen.armed
            assert not earlier or after.who != "ours", (before, seen)


def test_every_state_survives_its_way_through_the_journal() -> None:
    journal = TypeAdapter(Authority)
    for a in reachable():
        assert journal.validate_json(journal.dump_json(a)) == a


@given(st.lists(st.sampled_from(ALL), max_size=30))
def test_the_last_recorded_change_is_the_state_that_was_live(seen: list[Seen]) -> None:
    live = recorded = Authority()
    for one in seen:
        before, live = live, authority_after(live, one)
        if live != before:
            recorded = live
    assert recorded == live
