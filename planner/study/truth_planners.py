"""Who chooses the places of a truth study: the base policy, which looks at information alone, or the flown planner."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import hypot
from statistics import geometric_mean
from typing import Literal

from planner.belief.evidence import SMALLEST_SIGMA
from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief
from planner.options import CROSSFIX
from planner.plan import plan
from planner.policy.fisher import fisher
from planner.study.error_worlds import Row
from planner.study.errors import StudyError
from planner.types import Bearing, Decision, Problem

TruthPlanner = Literal["fisher", "crossfix"]
PLANNERS: tuple[TruthPlanner, ...] = ("fisher", "crossfix")
"""crossfix: the planner of the suggested mission, at its settings."""


def truth_planner(name: str) -> TruthPlanner:
    """StudyError for a name that is not known."""
    for one in PLANNERS:
        if one == name:
            return one
    raise StudyError(f"there is no planner {name!r}: choose one of {', '.join(PLANNERS)}")


def next_place(
    planner: TruthPlanner,
    problem: Problem,
    row: Row,
    belief: GridBelief,
    bearings: Sequence[Bearing],
    here: tuple[float, float],
) -> Decision:
    """The place of the next bearing, with echoes of its own as in flight. bearings: those in the belief; they state
    what the row states of each."""
    problem = replace(problem, turned_at=places_of(bearings))
    if planner == "fisher":
        return fisher(problem, belief, here)
    return plan(_foreseen(problem, row, belief, bearings), belief, bearings, here, CROSSFIX, threads=1)


def places_of(bearings: Sequence[Bearing]) -> tuple[tuple[float, float], ...]:
    """m ENU, where they were taken."""
    return tuple((bearing.x, bearing.y) for bearing in bearings)


def _foreseen(problem: Problem, row: Row, belief: GridBelief, bearings: Sequence[Bearing]) -> Problem:
    """sigma = hypot(scale sigma_own, bias' standard deviation) of bearings to come, as a mission plans with."""
    if not bearings:
        return problem
    stated = hypot(row.stated_sd, row.heading_sigma)
    sigma = geometric_mean([problem.sigma, *(stated for _ in bearings)])
    errors = belief.errors_of(bearings[-1].source) if isinstance(belief, JointBelief) else None
    if errors is not None:
        sigma = hypot(errors.scale * sigma * max(row.stated_sd, SMALLEST_SIGMA) / stated, errors.bias_sd)
    return replace(problem, sigma=sigma)
