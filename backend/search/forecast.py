"""What a place would cost, and what a mission may look like before take-off. Synchronous and pure; call in a thread."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from backend.events import BearingMeasured, CandidateFact
from backend.reasons import Reason
from backend.search.localization import Localization
from backend.search.planning import candidate_facts, cost_of, decide, in_nine_of_ten, to_plan, way_to
from backend.spec import Place
from planner.comparison import between_places, difference_between, difference_together, rules_against
from planner.policy.several import Wanted
from planner.reasons import RuleReason
from planner.types import PlannerError

Vetoes = Callable[[Place, Sequence[tuple[float, float]]], tuple[Reason, ...]]
"""What safety has against flying to a place by way of points in between (m ENU)."""


@dataclass(frozen=True, slots=True)
class Forecast:
    """reason: why the vehicle may not go there now (the times may still be known), None when it may.

    mean_s: mean time until localized by way of the place; p90_s: not exceeded by nine of ten searches, and
    never below the mean. None: unknown.
    """

    place: Place
    reason: Reason | None
    mean_s: float | None
    std_error_s: float | None
    p90_s: float | None
    rollouts: int


@dataclass(frozen=True, slots=True)
class Comparison:
    """difference_s: by which a place takes longer than another, on the same sample paths; negative: it is quicker.

    rules: why the planner may not choose the quicker place; empty for one that is not quicker.
    """

    difference_s: float
    std_error_s: float
    rules: tuple[Reason, ...] = ()

    @property
    def quicker(self) -> bool:
        """By more than chance."""
        return self.difference_s < -2.0 * self.std_error_s


@dataclass(frozen=True, slots=True)
class Preview:
    """Where a mission would measure first and how long it may take. times_s: sampled times until localized."""

    start: Place
    first_place: Place
    reason: Reason
    mean_s: float | None
    p90_s: float | None
    times_s: list[float]
    candidates: list[CandidateFact]
    rollouts: int
    plan_ms: float


def forecast(
    task: Localization, measured: Sequence[BearingMeasured], platform: Place, place: Place, vetoes: Vetoes
) -> Forecast:
    """From `platform`; `vetoes` is asked about the place and the way there."""
    start, end = (task.frame.to_enu(p) for p in (platform, place))
    cost = cost_of(task, task.planning_belief(task.planner_bearings(measured)), measured, start, end)
    against = vetoes(place, _way(task, start, end))
    reason = against[0] if against else cost.reason
    return Forecast(place, reason, cost.mean_s, cost.std_error_s, cost.p90_s, cost.rollouts)


def compare(
    wanted: Sequence[tuple[Localization, Sequence[BearingMeasured]]],
    platform: Place,
    place: Place,
    other: Place,
    ranks: Sequence[int] = (),
    avoid: Sequence[Place] = (),
) -> Comparison | None:
    """A place beside another by the measure of the mission's planner; None when one of them cannot be reached.

    wanted: the emitters that are looked for, each with its counted bearings. ranks: in their order of importance, none:
    they are alike. avoid: places that the planner leaves out.
    """
    (task, measured), *more = wanted
    start, here, there = (task.frame.to_enu(p) for p in (platform, place, other))
    options = task.mission.planner.options
    folded = [(one, facts, one.planning_belief(one.planner_bearings(facts))) for one, facts in wanted]
    problems = [(to_plan(one, facts, belief), belief) for one, facts, belief in folded]
    together = bool(more) and options.method == "rollout"
    try:
        if together:
            asked = [Wanted(p, b, rank) for (p, b), rank in zip(problems, ranks or [0] * len(problems), strict=True)]
            found = difference_together(asked, start, here, there, options)
        else:
            problem, belief = problems[0]
            bearings = task.planner_bearings(measured)
            found = difference_between(problem, belief, bearings, start, here, there, options)
    except PlannerError:
        return None
    if not math.isfinite(found.mean):
        return None
    compared = Comparison(found.mean, found.std_error)
    if not compared.quicker:
        return compared
    (problem, belief), *_ = problems
    if together:
        rules: Sequence[RuleReason] = between_places(problem)
    else:
        without = [task.frame.to_enu(p) for p in avoid]
        rules = rules_against(problem, belief, here, by_claim=found.by_claim, without=without)
    return replace(compared, rules=tuple(rules))


def _way(task: Localization, start: tuple[float, float], end: tuple[float, float]) -> list[tuple[float, float]]:
    try:
        return way_to(task, start, end)[:-1]
    except PlannerError:
        return []


def preview(task: Localization, start: Place, threads: int) -> Preview:
    """Plan the first place from the prior. Raises PlannerError when no place may be flown to."""
    began = time.perf_counter()
    belief = task.planning_belief(())
    decision = decide(task, belief, (), task.frame.to_enu(start), threads=threads)
    times = decision.times
    return Preview(
        start=start,
        first_place=task.place(decision.x, decision.y),
        reason=decision.reason,
        mean_s=float(times.mean()) if len(times) else None,
        p90_s=in_nine_of_ten(times),
        times_s=[float(t) for t in times],
        candidates=candidate_facts(task, decision),
        rollouts=decision.rollouts,
        plan_ms=1e3 * (time.perf_counter() - began),
    )
