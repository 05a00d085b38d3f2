"""What never stopping to turn needs of a mission, and what is foreseen of its legs."""

from __future__ import annotations

import math
from typing import Any

import pytest
from facts import HOME, OWN, PERSON, SPEC, bearing

from backend.reasons.turning import NeverStopNeeds, TurnsHere
from backend.search.errors import MissionInputError
from backend.search.localization import localization
from backend.search.never_stop import (
    LEAST_LEG_M,
    LEG_SIGMA_DEG,
    check_never_stop,
    turn_or_pass,
    why_turn_before_belief,
)
from backend.search.planning import foreseen, foreseen_to_plan
from backend.search.state import EmitterState
from backend.spec import FIRST_EMITTER, EmitterSpec, MissionSpec, MovementSpec
from planner.reason import sentence_of

ASKED: dict[str, Any] = {
    "bearing_errors": "joint",
    "listen_on_the_way": True,
    "swing_on_the_way": True,
    "never_stop": True,
}


def asking(emitters: list[EmitterSpec] | None = None, method: str = "rollout", **sensor: Any) -> MissionSpec:
    return SPEC.model_copy(
        update={
            "sensor": SPEC.sensor.model_copy(update={**ASKED, **sensor}),
            "emitters": emitters or SPEC.emitters,
            "planner": SPEC.planner.model_copy(update={"method": method}),
        }
    )


def test_a_mission_that_has_all_it_needs_may() -> None:
    check_never_stop(asking())
    check_never_stop(asking(never_stop=False, bearing_errors="independent", swing_on_the_way=False))


def test_where_it_turns_after_all_it_hears_all_directions_whatever_it_says_of_sectors() -> None:
    both = asking(sector_turns=True)
    check_never_stop(both)
    assert not both.sensor.turns_in_sectors
    assert localization(both, HOME).problem.sector_turns is None
    stopping = asking(sector_turns=True, never_stop=False)
    assert stopping.sensor.turns_in_sectors
    assert localization(stopping, HOME).problem.sector_turns is not None


@pytest.mark.parametrize(
    ("mission", "what"),
    [
        (asking([EmitterSpec(), EmitterSpec(emitter_id="other", frequency_hz=869.5e6)]), "one_emitter"),
        (asking([EmitterSpec(kind="pulsed")]), "carrier"),
        (asking([EmitterSpec(movement=MovementSpec(kind="walking", speed_m_s=1.0))]), "still"),
        (asking(bearing_errors="independent"), "joint"),
        (asking(listen_on_the_way=False), "swings"),
        (asking(swing_on_the_way=False), "swings"),
        (asking(method="base_policy"), "rollouts"),
    ],
)
def test_one_that_lacks_something_is_told_what(mission: MissionSpec, what: str) -> None:
    with pytest.raises(MissionInputError) as refused:
        check_never_stop(mission)
    assert refused.value.reason == NeverStopNeeds(what)  # type: ignore[arg-type]
    assert refused.value.field == "sensor.never_stop"
    assert "{" not in sentence_of(refused.value.reason)


def test_a_bearing_that_somebody_else_took_is_no_look_all_the_way_round() -> None:
    known = EmitterState(FIRST_EMITTER, measured=(bearing(1, source=PERSON),))
    assert why_turn_before_belief(known, "craft-1", 2) == TurnsHere("first")
    own = EmitterState(FIRST_EMITTER, measured=(bearing(1, source=OWN),))
    assert why_turn_before_belief(own, "craft-1", 2) == TurnsHere("told_nothing")


def test_what_nobody_believes_yet_is_turned_for() -> None:
    assert turn_or_pass(None, ()) == TurnsHere("contradicts")


def test_the_first_bearing_is_foreseen_as_a_turn_and_all_later_ones_as_legs() -> None:
    task = localization(asking(), HOME)
    first = foreseen_to_plan(task.problem, (), task.planning_belief(()))
    assert first.legs is None
    assert first.measurement_time == SPEC.sensor.measurement_time_s
    taken = [bearing(1)]
    belief = task.planning_belief(task.planner_bearings(taken))
    later = foreseen_to_plan(task.problem, taken, belief)
    assert later.legs is not None
    assert later.legs.least == LEAST_LEG_M
    assert later.sigma == later.legs.sigma > math.radians(0.5 * LEG_SIGMA_DEG)
    assert later.measurement_time < first.measurement_time


def test_others_are_foreseen_as_ever() -> None:
    task = localization(SPEC, HOME)
    taken = [bearing(1)]
    belief = task.planning_belief(task.planner_bearings(taken))
    assert task.problem.legs is None
    assert not task.rule.ways
    found, ever = foreseen_to_plan(task.problem, taken, belief), foreseen(task.problem, taken, belief)
    assert (found.sigma, found.measurement_time, found.legs) == (ever.sigma, ever.measurement_time, None)
