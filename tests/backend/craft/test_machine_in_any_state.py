"""The craft machine in every phase, whoever flies, at every stage of the search; also where no flight comes to."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import get_args

import pytest
from craft_inputs import AUTHORITIES, every_craft_input
from craft_sweep import stepped
from craft_walk import PHASES, craft_in
from facts import FAILSAFE, LANDED_BY_PILOT

from backend import commands
from backend.craft import effects
from backend.craft.state import evolve
from backend.events import MissionEnded, Phase, PreflightChecked
from backend.reasons.search import Localized
from backend.search.effects import Record
from backend.search.state import SearchState, Stage
from backend.search.state import evolve as evolve_search

# Without the tracer, which would make it five times as slow.
pytestmark = [pytest.mark.no_cover, pytest.mark.timeout(900)]

STAGES: tuple[Stage, ...] = get_args(Stage)
PREFLIGHT = PreflightChecked(passed=True, checks=[])


def of_stage(search: SearchState, stage: Stage) -> SearchState:
    match stage:
        case "draft" | "ready":
            checked = evolve_search(replace(search, started_at_s=None, outcome=None), PREFLIGHT, 0.0)
            return replace(checked, passed=stage == "ready")
        case "open":
            return replace(search, started_at_s=1_000.0, outcome=None)
        case "ended":
            begun = replace(search, started_at_s=1_000.0)
            return evolve_search(begun, MissionEnded(outcome="aborted", reason=Localized(), mission_time_s=1.0), 0.0)


@pytest.mark.parametrize("phase", PHASES)
def test_every_input_is_answered_in_every_phase_whoever_flies_in_whatever_stage(phase: Phase) -> None:
    """States that cannot be reached, too: whatever a journal holds, the craft can be held."""
    walk = craft_in(phase)
    for authority, stage, silent in product(AUTHORITIES, STAGES, (False, True)):
        down = frozenset({"vehicle"}) if silent else frozenset()
        craft = replace(walk.craft, authority=authority, links_down=down)  # type: ignore[arg-type]
        search = of_stage(walk.search, stage)
        for given in every_craft_input(craft, search):
            step = stepped(craft, search, given)
            folded = craft
            for effect in step.asked:
                if isinstance(effect, Record):
                    folded = evolve(folded, effect.event)
            assert folded == step.after, "the new state is the fold of the recorded facts"
            if isinstance(step.command, commands.Hold) and craft.engaged and not craft.taken_over:
                assert effects.HoldVehicle() in step.asked
                assert step.after.phase == "hold"


def test_who_has_control_after_a_landing_is_still_the_pilot_and_a_failsafe_never_is() -> None:
    craft = craft_in("manual").craft
    assert replace(craft, authority=LANDED_BY_PILOT).taken_over
    assert not replace(craft, authority=FAILSAFE).taken_over
