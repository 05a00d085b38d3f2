"""The mission machine: every state against every input, and the rules that hold on any walk."""

from __future__ import annotations

import pytest
from craft_inputs import ORDERS, every_craft_input
from craft_walk import MOVES, VEHICLE
from facts import (
    CHECK,
    FAILED_CHECK,
    IMPORT,
    OTHER_AREA,
    PERSON,
    SPEC,
    VETO,
    WAITING_SPEC,
    bearing,
    belief,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import PHASES, Walk, answer, belief_ready, commanded, refusal, walk_in

from backend import commands
from backend.craft import effects, inputs
from backend.events import MissionEnded
from backend.mission.effects import Effect, OfCraft, Reply
from backend.mission.inputs import Commanded, Context, Input, ServerCameBack, ToCraft
from backend.mission.machine import transition
from backend.mission.state import MissionState, fold
from backend.reasons.search import Localized
from backend.search.effects import Record
from backend.search.inputs import (
    BearingsArrived,
    BeliefFailed,
    BeliefReady,
    Edited,
    NotStored,
    PreflightDone,
    SearchOver,
)
from backend.spec import FIRST_EMITTER

SEARCHES = (effects.TakeOff, effects.FlyTo, effects.Measure)


def every_input(state: MissionState) -> list[Input]:
    """At least one of each kind, to the search and to its craft."""
    craft, search = next(iter(state.crafts.values())), state.search
    known = search.measured[0].bearing_id if search.measured else "unknown"
    alerts = [alert.alert_id for owner in (search, craft) for alert in owner.open_alerts] or ["unknown-1"]
    number = len(search.measured) + 1
    orders: tuple[commands.Command, ...] = (
        *ORDERS,
        commands.Hold(craft_id="nobody"),
        commands.ChangeArea(search=OTHER_AREA),
        commands.ExcludeBearing(bearing_id=known),
        commands.AcknowledgeAlert(alert_id=alerts[0]),
    )
    craft_inputs = [one for one in every_craft_input(craft, search) if not isinstance(one, inputs.CraftOrdered)]
    return [
        *(commanded(order, f"every-{i}") for i, order in enumerate(orders)),
        *(commanded(order, f"objected-{i}", Context((VETO,))) for i, order in enumerate(orders)),
        commanded(commands.Resume(), "on-ground", Context(on_ground=True)),
        Edited(WAITING_SPEC, "anna"),
        PreflightDone((CHECK,)),
        PreflightDone((FAILED_CHECK,)),
        BearingsArrived((bearing(number, source=PERSON, bearing_id=f"p{number}"),)),
        BearingsArrived((bearing(number, source=IMPORT, bearing_id=f"i{number}"),)),
        belief_ready(search),
        belief_ready(search, localized=True),
        BeliefReady(("stale",), belief(1)),
        BeliefFailed(search.behind(FIRST_EMITTER), FIRST_EMITTER),
        NotStored("a number is missing"),
        SearchOver(Localized(), "failed"),
        ServerCameBack(),
        ToCraft("nobody", inputs.Landed()),
        *(ToCraft(craft.craft_id, one) for one in craft_inputs),
    ]


def check_rules(before: MissionState, given_: Input, after: MissionState, asked: tuple[Effect, ...]) -> None:
    command = given_.command if isinstance(given_, Commanded) else None
    craft = next(iter(before.crafts.values()))
    moved = [e.effect for e in asked if isinstance(e, OfCraft) and isinstance(e.effect, VEHICLE)]
    if isinstance(command, commands.ForSearch):
        assert not moved, "what is asked of a search moves nothing"
    if craft.taken_over and not isinstance(command, commands.Resume | commands.Start):
        restarted = isinstance(given_, ToCraft) and isinstance(given_.given, inputs.Restarted)
        assert not moved or restarted, "a command went out while the pilot had control"
    if craft.phase in ("hold", "manual") and any(isinstance(e, MOVES) for e in moved):
        ordered = isinstance(command, commands.Resume | commands.Return | commands.Land | commands.Abort)
        expired = given_.given if isinstance(given_, ToCraft) else None
        refused = craft.ladder is not None and expired == inputs.TimerExpired("order")
        timer = expired == inputs.TimerExpired("console_return")
        counted = expired == inputs.TimerExpired("battery_return") and craft.counting_down
        lower = isinstance(expired, inputs.BatteryLow) and expired.stage != "return"
        assert ordered or timer or refused or counted or lower, f"{given_} moved a held vehicle"
    if craft.nets_wait and before.search.outcome is None:
        searching = [e for e in moved if isinstance(e, SEARCHES)]
        assert not searching, f"{given_} flew on before the nets of the new area hang"
        if isinstance(given_, Commanded) and isinstance(command, commands.Resume | commands.Override):
            taken_back = isinstance(command, commands.Resume) and craft.phase == "manual" and after.phase == "hold"
            assert refusal(asked) is not None or given_.command_id in before.answered or taken_back
    kept = next(iter(after.crafts.values())).nets_wait
    hung = isinstance(given_, ToCraft) and isinstance(given_.given, inputs.NetsUp)
    started = isinstance(command, commands.Start)
    assert kept or not craft.nets_wait or hung or started, f"{given_} forgot that the nets do not hang"
    if before.search.outcome is not None:
        assert after.search.outcome == before.search.outcome
        assert after.phase == before.phase
    if command is not None:
        assert answer(asked).command_id in after.answered
        assert sum(isinstance(e, Reply) for e in asked) == 1
        assert (refusal(asked) is None) == after.answered[answer(asked).command_id].accepted
    if isinstance(given_, BearingsArrived) and craft.chosen is not None:
        assert after.crafts[craft.craft_id].chosen == craft.chosen, "a bearing from elsewhere takes no destination"
        assert not moved
    if before.search.stage == "open" and after.search.stage == "ended" and not isinstance(given_, SearchOver):
        assert not any(craft.searching for craft in after.crafts.values())


@pytest.mark.parametrize("phase", PHASES)
def test_every_input_is_answered_in_every_phase(phase: str) -> None:
    start = walk_in(phase).state
    for given_ in every_input(start):
        after, asked = transition(start, given_, 2_000.0)
        check_rules(start, given_, after, asked)
        for again in every_input(after):
            twice, more = transition(after, again, 2_001.0)
            check_rules(after, again, twice, more)


def test_in_another_area_every_input_is_answered_before_its_nets_hang_and_after_a_restart_too() -> None:
    """Three steps: what comes first (a server that was away, say), and all that may follow."""
    walk = Walk().to("hold")
    walk.command(commands.ChangeArea(search=OTHER_AREA))
    assert walk.craft.nets_wait
    for first in every_input(walk.state):
        between, asked = transition(walk.state, first, 2_000.0)
        check_rules(walk.state, first, between, asked)
        for given_ in every_input(between):
            after, asked = transition(between, given_, 2_001.0)
            check_rules(between, given_, after, asked)


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
        if isinstance(given_, Commanded):
            given_ = Commanded(f"walk-{number}", given_.author, given_.command, given_.contexts, given_.search)
        before = walk.state
        asked = walk.give(given_)
        check_rules(before, given_, walk.state, asked)
        ended += sum(isinstance(e, Record) and isinstance(e.event, MissionEnded) for e in asked)
        assert ended <= 1
    assert fold(walk.recorded) == walk.state
