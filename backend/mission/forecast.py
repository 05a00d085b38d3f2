"""What a place would cost, and what a mission may look like before take-off. Synchronous and pure; call in a thread."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

from backend.events import BearingMeasured, CandidateFact
from backend.mission.localization import Localization
from backend.mission.planning import candidate_facts, cost_of, decide, in_nine_of_ten, way_to
from backend.mission.safety import Situation, place_vetoes, standing_vetoes
from backend.spec import Place
from hardware.readings import GeoPoint
from planner.types import PlannerError


@dataclass(frozen=True, slots=True)
class Forecast:
    """allowed False: the vehicle may not go there now, `reason` says why (the times may still be known).

    mean_s: mean time until localized by way of the place; p90_s: not exceeded in at least 90 % of the rollouts and
    never below the mean. None: unknown.
    """

    place: Place
    allowed: bool
    reason: str
    mean_s: float | None
    std_error_s: float | None
    p90_s: float | None
    rollouts: int


@dataclass(frozen=True, slots=True)
class Preview:
    """Where a mission would measure first and how long it may take. times_s: sampled times until localized."""

    start: Place
    first_place: Place
    reason: str
    mean_s: float | None
    p90_s: float | None
    times_s: list[float]
    candidates: list[CandidateFact]
    rollouts: int
    plan_ms: float


def forecast(
    task: Localization, measured: Sequence[BearingMeasured], platform: Place, place: Place, situation: Situation | None
) -> Forecast:
    """situation None: the vehicle is not asked (before take-off)."""
    start, end = (task.frame.to_enu(GeoPoint(p.lat, p.lon)) for p in (platform, place))
    cost = cost_of(task, task.planning_belief(task.planner_bearings(measured)), measured, start, end)
    altitude, point = task.limits.home_amsl_m + task.mission.flight.altitude_relative_m, GeoPoint(place.lat, place.lon)
    if situation is None:
        vetoes = standing_vetoes(task.limits, point, altitude)
    else:
        vetoes = place_vetoes(task.limits, situation, point, altitude, _way(task, start, end))
    reason = vetoes[0].detail if vetoes else cost.reason
    return Forecast(place, not reason, reason, cost.mean_s, cost.std_error_s, cost.p90_s, cost.rollouts)


def _way(task: Localization, start: tuple[float, float], end: tuple[float, float]) -> list[tuple[float, float]]:
    try:
        return way_to(task, start, end)[:-1]
    except PlannerError:
        return []


def preview(task: Localization, start: Place, threads: int) -> Preview:
    """Plan the first place from the prior. Raises PlannerError when no place may be flown to."""
    began = time.perf_counter()
    belief = task.planning_belief(())
    decision = decide(task, belief, (), task.frame.to_enu(GeoPoint(start.lat, start.lon)), threads=threads)
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
