"""The control lease: every state by every command and person, what holds on any walk, and attacks on it."""

from __future__ import annotations

from itertools import product
from uuid import uuid4

import pytest
from hypothesis import given
from hypothesis import strategies as st
from walks import Walk, refusal, walk_in

from backend import commands
from backend.commands import Author, Command, ForControl
from backend.events import CommandRefused, ControlAsked, ControlChanged, ControlKept, Holder
from backend.mission.control import UNANSWERED_S, Control, decide, evolve, objection
from backend.mission.inputs import Commanded, Context
from backend.mission.machine import transition
from backend.mission.state import fold
from backend.permissions import COMMANDS
from backend.reasons import access
from planner.reason import Reason

ANNA = Author("Anna", "p-anna", "operator", "10.0.0.2")
BEN = Author("Ben", "p-ben", "operator", "10.0.0.3")
PIA = Author("Pia", "p-pia", "pilot", "10.0.0.4")
ALONE = Author("operator")
PEOPLE = (ANNA, BEN, PIA)
LEASE: tuple[ForControl, ...] = (
    commands.TakeControl(),
    commands.AskControl(),
    commands.GiveControl(),
    commands.KeepControl(),
    commands.ReleaseControl(),
)
ASKED_AT_S = 1_000.0
FACTS = ControlChanged | ControlAsked | ControlKept


def held(author: Author) -> Holder:
    return Holder(person=author.person or "", name=author.name)


HOLDERS = (None, *map(held, PEOPLE))
STATES = [Control(holder, 7, asked, ASKED_AT_S) for holder, asked in product(HOLDERS, HOLDERS) if holder or not asked]
AT_S = (ASKED_AT_S - 500.0, ASKED_AT_S, ASKED_AT_S + UNANSWERED_S - 0.1, ASKED_AT_S + UNANSWERED_S, ASKED_AT_S + 1e6)


@pytest.mark.parametrize("at_s", AT_S)
@pytest.mark.parametrize("gone", [False, True])
def test_who_may_take_it_is_exactly_this_in_every_state(gone: bool, at_s: float) -> None:
    for state, author in product(STATES, PEOPLE):
        took = isinstance(decide(state, author, commands.TakeControl(), gone, at_s), ControlChanged)
        unanswered = state.asked == held(author) and at_s - ASKED_AT_S >= UNANSWERED_S
        may = state.holder in (None, held(author)) or gone or author.role == "pilot" or unanswered
        assert took == may, (state, author)


@pytest.mark.parametrize("at_s", AT_S)
def test_every_change_of_hands_counts_the_fence_up_and_nothing_else_changes_it(at_s: float) -> None:
    for state, author, command, gone in product(STATES, PEOPLE, LEASE, (False, True)):
        decided = decide(state, author, command, gone, at_s)
        if not isinstance(decided, FACTS):
            continue
        after = evolve(state, decided, at_s)
        if isinstance(decided, ControlChanged):
            assert after.fence == state.fence + 1
            assert after.asked is None
        else:
            assert (after.holder, after.fence) == (state.holder, state.fence)


def test_only_its_holder_gives_keeps_or_releases_it() -> None:
    for state, author in product(STATES, PEOPLE):
        for command in (commands.GiveControl(), commands.KeepControl(), commands.ReleaseControl()):
            done = isinstance(decide(state, author, command, True, 0.0), FACTS)
            needs_asker = not isinstance(command, commands.ReleaseControl)
            assert done == (state.holder == held(author) and (state.asked is not None or not needs_asker))


def test_where_there_are_no_accounts_no_lease_binds_and_none_is_made() -> None:
    for state, command in product(STATES, LEASE):
        assert decide(state, ALONE, command, False, 0.0) == access.ControlNeedless()
    for state, order in product(STATES, orders()):
        assert objection(state, ALONE, None, order) is None


def orders() -> list[Command]:
    """One of every kind that can be made without values, which is every kind of both tables but these."""
    kinds = {
        "override",
        "set_automatic",
        "change_area",
        "exclude_bearing",
        "include_bearing",
        "mute_source",
        "set_priorities",
        "acknowledge_alert",
    }
    made: list[Command] = [
        commands.Start(), commands.Hold(), commands.Resume(), commands.Return(), commands.Land(), commands.Abort(),
        commands.KeepHolding(), commands.Accept(), commands.Veto(), *LEASE,
    ]  # fmt: skip
    assert {one.kind for one in made} | kinds == set(COMMANDS)
    return made


def test_steering_takes_the_lease_and_its_number_and_what_is_safe_takes_neither() -> None:
    for state, author, order, fence in product(STATES, PEOPLE, orders(), (None, 6, 7, 8)):
        against = objection(state, author, fence, order)
        if not COMMANDS[order.kind].control:
            assert against is None, order
        else:
            assert (against is None) == (state.holder == held(author) and fence == 7), (state, author, order)


@given(st.lists(st.tuples(st.sampled_from(PEOPLE), st.sampled_from(LEASE), st.floats(-60, 90)), max_size=40))
def test_on_any_walk_one_holds_it_and_no_fence_comes_twice(walk: list[tuple[Author, ForControl, float]]) -> None:
    """The clock jumps, backwards too."""
    state, at_s, fences = Control(), 1_000.0, list[int]()
    for author, command, step_s in walk:
        at_s += step_s
        decided = decide(state, author, command, False, at_s)
        if isinstance(decided, FACTS):
            state = evolve(state, decided, at_s)
        if isinstance(decided, ControlChanged):
            fences.append(decided.fence)
        if state.asked is not None:
            assert state.holder not in (None, state.asked)
    assert fences == sorted(set(fences))


def test_a_clock_that_was_set_back_holds_up_only_until_it_is_asked_again() -> None:
    state = evolve(Control(held(ANNA), 1), ControlAsked(holder=held(BEN), by="Ben"), 10_000.0)
    assert decide(state, BEN, commands.TakeControl(), False, 5_000.0) == access.ControlHeld("Anna")
    again = decide(state, BEN, commands.AskControl(), False, 5_000.0)
    assert isinstance(again, ControlAsked)
    state = evolve(state, again, 5_000.0)
    assert isinstance(decide(state, BEN, commands.TakeControl(), False, 5_000.0 + UNANSWERED_S), ControlChanged)


# through the mission's machine


class Shared(Walk):
    """A walk of several people, and how each order was answered."""

    def by(self, author: Author, command: Command, fence: int | None = None, command_id: str = "") -> Reason | None:
        given_ = Commanded(command_id or str(uuid4()), author, command, {self.craft.craft_id: Context()}, fence=fence)
        return refusal(self.give(given_))

    @property
    def fence(self) -> int:
        return self.state.control.fence


def in_flight() -> Shared:
    walk = Shared()
    walk.to("waiting")
    assert walk.by(ANNA, commands.TakeControl()) is None
    return walk


def test_a_stale_fence_crosses_no_takeover() -> None:
    """Anna's order was under way while a pilot took control and gave it back to her."""
    walk = in_flight()
    old = walk.fence
    assert walk.by(PIA, commands.TakeControl()) is None
    assert walk.by(ANNA, commands.SetAutomatic(automatic=False), old) == access.ControlHeld("Pia")
    assert walk.by(ANNA, commands.AskControl()) is None
    assert walk.by(PIA, commands.GiveControl()) is None
    assert walk.by(ANNA, commands.SetAutomatic(automatic=False), old) == access.ControlStale()
    assert walk.by(ANNA, commands.SetAutomatic(automatic=False), walk.fence) is None


@pytest.mark.parametrize("order", [commands.Hold(), commands.Abort(), commands.Return(), commands.Land()])
@pytest.mark.parametrize("fence", [None, 0, 99])
def test_what_is_safe_is_open_to_whoever_does_not_control(order: Command, fence: int | None) -> None:
    walk = in_flight()
    assert walk.by(BEN, order, fence) is None


def test_the_journal_keeps_who_ordered_from_where_and_folds_back() -> None:
    walk = in_flight()
    assert walk.by(BEN, commands.SetAutomatic(automatic=False), 1) == access.ControlHeld("Anna")
    refused = walk.of_kind(CommandRefused)[-1]
    assert refused.author is not None
    assert (refused.by, refused.author.person, refused.author.role) == ("Ben", "p-ben", "operator")
    assert refused.author.address == "10.0.0.3"
    assert fold(walk.recorded) == walk.state


def test_a_command_id_belongs_to_its_order() -> None:
    walk = in_flight()
    same = str(uuid4())
    assert walk.by(ANNA, commands.Hold(), command_id=same) is None
    facts = len(walk.recorded)
    assert walk.by(ANNA, commands.Hold(), command_id=same) is None, "sent twice, answered as before"
    for other in (commands.Abort(), commands.Hold(craft_id=walk.craft.craft_id), commands.Return()):
        assert walk.by(ANNA, other, command_id=same) == access.CommandIdReused("hold")
    assert len(walk.recorded) == facts, "nothing was done"
    assert walk.by(ANNA, commands.Hold(), command_id=same) is None, "the first answer stands"


def test_an_id_of_an_older_journal_is_bound_to_its_kind() -> None:
    walk = walk_in("hold")
    state = walk.state
    old = {key: answer.__class__(True, None, answer.command) for key, answer in state.answered.items()}
    held_id = next(key for key, answer in old.items() if answer.command == "hold")
    state = state.__class__(state.search, state.crafts, old)
    for command, wanted in ((commands.Hold(), None), (commands.Abort(), access.CommandIdReused("hold"))):
        _, asked = transition(state, Commanded(held_id, ALONE, command), 5_000.0)
        assert refusal(asked) == wanted
