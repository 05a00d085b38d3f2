"""The mission machine when the search area changes in flight."""

from __future__ import annotations

import pytest
from facts import (
    OTHER_AREA,
    SPEC,
    VETO,
    bearing,
    plan,
)
from walks import PHASES, Walk, of_craft, refusal, sent, walk_in

from backend import commands
from backend.craft import effects, inputs
from backend.events import CommandRefused
from backend.mission.inputs import Context
from backend.mission.state import fold
from backend.search.effects import SearchElsewhere, UpdateBelief
from backend.spec import FIRST_EMITTER


@pytest.mark.parametrize("phase", PHASES)
def test_the_area_changes_in_hold_only_and_moves_nothing(phase: str) -> None:
    walk = walk_in(phase)
    before = walk.search.spec
    asked = walk.command(commands.ChangeArea(search=OTHER_AREA))
    assert sent(asked) == []
    if phase == "hold":
        assert refusal(asked) is None
        assert asked.count(UpdateBelief(FIRST_EMITTER)) == 1
        assert SearchElsewhere() in asked
        assert walk.search.spec == SPEC.searching(OTHER_AREA)
    else:
        assert refusal(asked) is not None
        assert walk.search.spec == before
    assert walk.state.phase == walk_in(phase).state.phase


def test_bearings_count_on_in_another_area_and_what_was_planned_for_the_old_is_void() -> None:
    walk = Walk().to("measuring")
    walk.to_craft(inputs.SweepTaken((bearing(1),)))
    walk.believe()
    walk.to_craft(inputs.Planned(plan(2)))
    walk.command(commands.SetAutomatic(automatic=False))
    walk.command(commands.Hold())
    walk.command(commands.ChangeArea(search=OTHER_AREA))
    assert walk.search.emitters[FIRST_EMITTER].bearing_ids == ("b1",)
    assert (walk.craft.chosen, walk.search.beliefs_current, walk.craft.automatic) == (None, False, False)
    walk.believe()
    assert of_craft(walk.command(commands.Resume()))[-1] == effects.PlanNext(3, ())
    assert fold(walk.recorded) == walk.state


def test_objections_refuse_another_area() -> None:
    walk = Walk().to("hold")
    asked = walk.command(commands.ChangeArea(search=OTHER_AREA), Context((VETO,)))
    assert refusal(asked) == VETO
    assert walk.search.spec == SPEC
    (refused,) = walk.of_kind(CommandRefused)
    assert refused.reason == VETO
