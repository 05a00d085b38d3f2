"""The order of importance while craft fly: it moves none, and the next plan follows it."""

from __future__ import annotations

import pytest
from facts import OURS, SECOND, TWO_SPEC, bearing, plan
from walks import PHASES, Walk, of_craft, refusal, sent

from backend import commands
from backend.craft import effects, inputs
from backend.mission.inputs import ServerCameBack
from backend.mission.state import fold
from backend.reasons import refusals
from backend.spec import FIRST_EMITTER, FlightSpec

SECOND_FIRST = commands.SetPriorities(priorities={SECOND: 1})
WAITING_TWO = TWO_SPEC.model_copy(update={"flight": FlightSpec(automatic=False)})


@pytest.mark.parametrize("phase", [phase for phase in PHASES if phase not in ("planning", "waiting")])
def test_in_no_phase_does_it_move_a_craft(phase: str) -> None:
    walk = Walk(TWO_SPEC).to(phase)
    before = walk.state.crafts
    asked = walk.command(SECOND_FIRST)
    assert sent(asked) == []
    assert walk.state.crafts == before
    assert fold(walk.recorded) == walk.state


def test_what_is_being_planned_is_planned_again_and_a_proposal_too() -> None:
    walk = Walk(TWO_SPEC).to("planning")
    walk.believe()
    assert of_craft(walk.command(SECOND_FIRST)) == [effects.PlanNext(1, ())]
    proposed = Walk(WAITING_TWO).to("waiting")
    assert proposed.craft.chosen is not None
    assert of_craft(proposed.command(SECOND_FIRST)) == [effects.PlanNext(2, ())]
    assert (proposed.craft.phase, proposed.craft.chosen) == ("planning", None)
    proposed.to_craft(inputs.Planned(plan(2)))
    assert proposed.craft.phase == "waiting"
    assert fold(proposed.recorded) == proposed.state


def test_a_restart_in_the_middle_keeps_the_order() -> None:
    walk = Walk(TWO_SPEC).to("flying")
    walk.command(SECOND_FIRST)
    walk.give(ServerCameBack())
    walk.to_craft(inputs.Restarted(OURS))
    assert walk.search.mission.priorities == {SECOND: 1}
    assert [one.emitter_id for one in walk.search.sought] == [SECOND, FIRST_EMITTER]
    assert fold(walk.recorded) == walk.state


def test_the_search_still_ends_only_when_all_are_localized() -> None:
    walk = Walk(TWO_SPEC).to("flying").arrive()
    walk.command(SECOND_FIRST)
    walk.to_craft(inputs.SweepTaken((bearing(1, bearing_id="a1"), bearing(1, SECOND, bearing_id="b1"))))
    walk.believe(True, SECOND)
    assert of_craft(walk.believe(False, FIRST_EMITTER)) == [effects.PlanNext(2, ())]
    walk.to_craft(inputs.Planned(plan(2)))
    walk.arrive()
    walk.to_craft(inputs.SweepTaken((bearing(2, bearing_id="a2"),)))
    assert sent(walk.believe(True, FIRST_EMITTER)) == [effects.ReturnHome()]


def test_the_same_order_given_twice_by_its_id_is_carried_out_once_and_an_unknown_emitter_is_refused() -> None:
    walk = Walk(TWO_SPEC).to("flying")
    assert refusal(walk.command(commands.SetPriorities(priorities={"nobody": 1}))) == refusals.NoSuchEmitter("nobody")
    assert walk.search.mission == TWO_SPEC
