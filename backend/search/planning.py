"""The planner asked in the mission's words: the next place, what a place costs, a preview before take-off.

Everything here is synchronous and pure; the runner calls it in a thread, the kernel releases the interpreter lock.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from statistics import fmean, geometric_mean

import numpy as np

from backend.events import FIRST_CRAFT, BearingMeasured, CandidateFact, CraftSource, ForecastFact, PlanChosen
from backend.reasons import Reason
from backend.search.localization import Localization
from backend.search.planner_bearings import own_sigma_deg, source_name
from backend.spec import MissionSpec
from hardware.readings import Place
from planner.belief.grid import GridBelief
from planner.belief.joint import SMALLEST_SIGMA, JointBelief
from planner.belief.moving import MovingBelief
from planner.belief.source_errors import fielded_spread
from planner.belief.verdict import missing_crossing
from planner.legs import flown_by_legs
from planner.movement import FLIGHT_S
from planner.plan import expected_time_from, plan
from planner.policy.actions import SAME_PLACE_M
from planner.policy.base import BASE_POLICIES
from planner.policy.several import Wanted, plan_several
from planner.travel import straight_suffices, travel_path, visibility_graph
from planner.types import Decision, FloatArray, PlannerError, Problem, Ring

COST_ROLLOUTS = 200

SPECIFIED_COUNTS = 4
"""Bearings that the specified sigma counts as. From place to place sigmas differ by a factor of 1.8 (ln: 0.6), and one
says nothing of the next (167 of the field world: r = -0.1 and 0.1); what a craft's sigmas have in common differs from
the specification by 1.35 (ln: 0.3): 0.6^2 / 0.3^2."""
SWUNG_LOOKS = 2
"""What a place tells where the nose swings on the way to it, in turns: the leg says as much as one of a carrier
(decision 61). Of pulses a leg hears as few as its time holds, where a turn waits for enough of them."""
ECHOES_AHEAD = 1.22
"""Until a craft has a bearing, simulated ones meet no outlier and leave none to be doubted, so that those that listen
at places only took 1.35 times what was said (100 of the field world), those that never stop 1.2 times. Where the nose
swings on the way to turns, what the legs to come tell makes up for it, and neither is reckoned: missions took 0.97
times what was said. Of carriers: searches for tags were not flown among echoes."""

NOT_SIMULATED = 1.25
"""Of 4,905 plans of the field world after the first bearing 82 % kept the simulated times' 90 % quantile, 90 % this
many times as much."""

MEASURING_S, WORN_FROM_M = 30.0, 60.0
"""Of a moving emitter's search: how long a turn usually takes, and how far off bearings are taken."""


def next_place(
    task: Localization,
    belief: GridBelief,
    measured: Sequence[BearingMeasured],
    platform: tuple[float, float],
    place_number: int,
    avoid: Sequence[Place],
    threads: int,
    craft_id: str = FIRST_CRAFT,
) -> PlanChosen:
    """The planner's choice for this emitter as a fact. Raises PlannerError when no place is allowed or reachable."""
    began = time.perf_counter()
    without = [task.frame.to_enu(p) for p in avoid]
    decision = decide(task, belief, measured, platform, without, threads)
    return _plan_fact(task, decision, place_number, craft_id, task.emitter_id, began)


def next_place_together(
    wanted: Sequence[tuple[Localization, Sequence[BearingMeasured]]],
    platform: tuple[float, float],
    place_number: int,
    avoid: Sequence[Place],
    threads: int,
    craft_id: str = FIRST_CRAFT,
    ranks: Sequence[int] = (),
) -> PlanChosen:
    """The choice for several emitters (each with its counted bearings) that one turn hears at once; it is to tell most
    of none of them. ranks: in their order of importance, none: they are alike. Raises PlannerError when no place is
    allowed or reachable."""
    began = time.perf_counter()
    task = wanted[0][0]
    decision = plan_several(
        [_still_wanted(*one, rank) for one, rank in zip(wanted, ranks or [0] * len(wanted), strict=True)],
        platform,
        task.mission.planner.options,
        threads=threads,
        without=[task.frame.to_enu(place) for place in avoid],
    )
    forecasts = [
        ForecastFact(emitter_id=one.emitter_id, expected_time_s=float(times.mean()))
        for (one, _), times in zip(wanted, decision.each, strict=True)
    ]
    return _plan_fact(task, decision, place_number, craft_id, None, began, forecasts)


def _still_wanted(task: Localization, measured: Sequence[BearingMeasured], rank: int) -> Wanted:
    belief = task.planning_belief(task.planner_bearings(measured))
    return Wanted(to_plan(task, measured, belief), belief, rank, task.mission.name_of(task.emitter_id))


def _plan_fact(
    task: Localization,
    decision: Decision,
    place_number: int,
    craft_id: str,
    emitter_id: str | None,
    began: float,
    forecasts: Sequence[ForecastFact] = (),
) -> PlanChosen:
    """began: by time.perf_counter."""
    plan_ms = 1e3 * (time.perf_counter() - began)
    times = decision.times
    chosen = next((c for c in decision.candidates if (c.x, c.y) == (decision.x, decision.y)), None)
    mean = float(times.mean()) if len(times) else None if chosen is None else chosen.value
    return PlanChosen(
        craft_id=craft_id,
        emitter_id=emitter_id,
        place_number=place_number,
        place=task.place(decision.x, decision.y),
        source="planner",
        reason=decision.reason,
        expected_time_s=mean,
        time_90_s=in_nine_of_ten(times),
        candidates=candidate_facts(task, decision),
        rollouts=decision.rollouts,
        plan_ms=plan_ms,
        forecasts=list(forecasts),
    )


def decide(
    task: Localization,
    belief: GridBelief,
    measured: Sequence[BearingMeasured],
    platform: tuple[float, float],
    without: Sequence[tuple[float, float]] = (),
    threads: int = 1,
) -> Decision:
    """The planner that the specification names."""
    options = task.mission.planner.options
    if options.method == "base_policy":
        return base_policy_decision(task, measured, belief, platform, without)
    return plan(
        to_plan(task, measured, belief),
        belief,
        task.planner_bearings(measured),
        platform,
        options,
        threads=threads,
        without=without,
    )


def to_plan(task: Localization, measured: Sequence[BearingMeasured], belief: GridBelief) -> Problem:
    """What is foreseen, and what the next bearing must cross where a claim waits for nothing but that."""
    problem = foreseen_for(task, measured, belief)
    crossing = missing_crossing(problem, task.rule, task.planner_bearings(measured), belief)
    return replace(problem, crossing=crossing, turned_at=turned_at(task, measured))


def turned_at(task: Localization, measured: Sequence[BearingMeasured]) -> tuple[tuple[float, float], ...]:
    """m ENU, where crafts have bearings from. Of none where the emitter moves: its echoes move with it."""
    if task.moving:
        return ()
    return tuple(task.frame.to_enu(fact.place) for fact in measured if isinstance(fact.source, CraftSource))


def foreseen_for(task: Localization, measured: Sequence[BearingMeasured], belief: GridBelief) -> Problem:
    """As `foreseen_to_plan`. What turns took that were made for more emitters says nothing of those to come."""
    sensor, carrier = task.mission.sensor, task.mission.emitter(task.emitter_id).kind == "carrier"
    looks = SWUNG_LOOKS if carrier and sensor.listen_on_the_way and sensor.swing_on_the_way else 1
    found = foreseen_to_plan(task.problem, measured, belief, looks)
    unflown = not any(isinstance(fact.source, CraftSource) for fact in measured)
    if unflown and carrier and (looks == 1 or sensor.never_stop) and isinstance(belief, JointBelief):
        found = replace(found, sigma=ECHOES_AHEAD * found.sigma)
    return replace(found, measurement_time=task.problem.measurement_time) if task.fewer_turned_for else found


def foreseen_to_plan(
    problem: Problem, measured: Sequence[BearingMeasured], belief: GridBelief, looks: int = 1
) -> Problem:
    """What is foreseen of the bearings to come, those of legs where the craft turns at no place. It turns at the first
    one: until then all are foreseen as turns, so that a preview says rather too much. looks: as `foreseen`."""
    found = foreseen(problem, measured, belief, looks)
    flown = [fact.source for fact in measured if isinstance(fact.source, CraftSource)]
    if found.legs is None or not flown:
        return replace(found, legs=None)
    errors = belief.errors_of(source_name(flown[-1])) if isinstance(belief, JointBelief) else None
    if errors is not None:
        sigma = math.hypot(errors.scale * found.legs.sigma, errors.bias_sd)
        found = replace(found, legs=replace(found.legs, sigma=sigma))
    return flown_by_legs(found)


def foreseen(
    problem: Problem, measured: Sequence[BearingMeasured], belief: GridBelief | None = None, looks: int = 1
) -> Problem:
    """The problem with the sensor as this mission found it, for the bearings to come: those of the craft that measured
    last. What others told, and how well, says nothing of them.

    sigma = (sigma_specified^k prod_i sigma_i)^(1/(n+k)), k = SPECIFIED_COUNTS: a geometric mean, since sigma is a
    scale: one bad sweep in a good signal does not undo the others. The measurement time is the arithmetic mean, since
    missions add it up; there the specification counts as one.
    A joint belief knows more: of sigma only each bearing's own share counts, times the scale that was found, and the
    bias by as much as it is still uncertain. Before the first bearing it is what earlier flights make of the specified
    sigma. looks: how many turns a place is worth after the first one; they share the bias.
    """
    flown = (fact.source for fact in reversed(measured) if isinstance(fact.source, CraftSource))
    craft = next(flown, CraftSource(craft_id=FIRST_CRAFT))
    own, next_source = [fact for fact in measured if fact.source == craft], source_name(craft)
    sigmas = [math.radians(fact.sigma_deg) for fact in own if fact.sigma_deg > 0.0]
    sigma = geometric_mean([problem.sigma] * SPECIFIED_COUNTS + sigmas)
    sigma = _with_errors(sigma, own, next_source, belief, looks)
    times = [problem.measurement_time, *(t for fact in measured if (t := fact.measurement_time_s) is not None)]
    return replace(problem, sigma=sigma, measurement_time=fmean(times), next_source=next_source)


def _with_errors(
    sigma: float, own: Sequence[BearingMeasured], source: str, belief: GridBelief | None, looks: int
) -> float:
    """sigma_foreseen = hypot(scale sigma_own / sqrt(looks), bias' standard deviation), of the source that took `own`
    and measures next; rad."""
    if isinstance(belief, MovingBelief):
        return _worn(sigma, own, belief)
    if not isinstance(belief, JointBelief):
        return sigma
    if not own:
        return sigma * _learned_share(sigma, belief)
    errors = belief.errors_of(source)
    if errors is None:
        return sigma
    shares = [max(own_sigma_deg(fact), math.degrees(SMALLEST_SIGMA)) / max(fact.sigma_deg, 1e-3) for fact in own]
    return math.hypot(errors.scale * sigma * geometric_mean(shares) / math.sqrt(looks), errors.bias_sd)


def _worn(sigma: float, own: Sequence[BearingMeasured], belief: MovingBelief) -> float:
    """Of an emitter that moves. A rollout's belief stands still, so its bearings count for what they are worth one
    bearing later: sigma_foreseen^2 = sigma^2 + var(way in one step) / r^2."""
    spent = [t for fact in own if (t := fact.measurement_time_s) is not None]
    step_s = FLIGHT_S + (fmean(spent) if spent else MEASURING_S)
    return math.hypot(sigma, math.sqrt(float(belief.assumed.movement.variance(step_s))) / WORN_FROM_M)


def _learned_share(sigma: float, belief: JointBelief) -> float:
    """Expected error of a bearing after what was learned of its craft, over that of one that never flew; 1 when nothing
    was, or when several sources are known."""
    if len(belief.priors) != 1:
        return 1.0
    (known,) = belief.priors.values()
    learned, unknown = (
        math.hypot(sigma * math.sqrt(prior.scale_weight @ prior.scale**2), prior.bias_sd)
        for prior in (known, fielded_spread(belief.otherwise))
    )
    return learned / unknown


def base_policy_decision(
    task: Localization,
    measured: Sequence[BearingMeasured],
    belief: GridBelief,
    platform: tuple[float, float],
    without: Sequence[tuple[float, float]],
) -> Decision:
    """The base policy alone, refused places kept out of the action space."""
    refused = (*task.problem.no_fly, *(_around(place) for place in without))
    problem = replace(task.problem, no_fly=refused, turned_at=turned_at(task, measured))
    return BASE_POLICIES[task.mission.planner.base_policy](problem, belief, platform)


DEGREES_DIGITS, SECONDS_DIGITS = 8, 2
"""Of the candidates in a fact: a millimetre, a hundredth of a second. The place that is chosen keeps all digits."""


def candidate_facts(task: Localization, decision: Decision) -> list[CandidateFact]:
    """The candidates that were simulated at all."""
    facts: list[CandidateFact] = []
    for c in decision.candidates:
        if c.rollouts == 0 or not math.isfinite(c.value):
            continue
        place = task.place(c.x, c.y)
        if (c.x, c.y) != (decision.x, decision.y):
            place = Place(lat=round(place.lat, DEGREES_DIGITS), lon=round(place.lon, DEGREES_DIGITS))
        error = round(c.std_error, SECONDS_DIGITS) if math.isfinite(c.std_error) else None
        facts.append(
            CandidateFact(
                lat=place.lat,
                lon=place.lon,
                value_s=round(c.value, SECONDS_DIGITS),
                std_error_s=error,
                rollouts=c.rollouts,
                dropped_in_round=c.dropped_in_round,
            )
        )
    return facts


def needs_program(mission: MissionSpec) -> bool:
    """Whether the mission's plans stand on the dynamic program, whose table takes a while on a new machine."""
    return mission.planner.base_policy == "dynamic_program"


def lay_out_ways(task: Localization) -> None:
    """What flying around no-fly areas needs, before anybody waits for it: seconds for a coast of a thousand corners."""
    if not straight_suffices(task.problem):
        visibility_graph(task.problem)


def way_to(task: Localization, start: tuple[float, float], end: tuple[float, float]) -> list[tuple[float, float]]:
    """Way points (m ENU) after `start`, `end` included: straight, or around what may not be crossed.

    Raises PlannerError when there is no way.
    """
    return [(float(x), float(y)) for x, y in travel_path(task.problem, np.array(start), np.array(end))[1:]]


@dataclass(frozen=True, slots=True)
class Cost:
    """What measuring at a place next would mean. mean_s and p90_s None: it cannot be reached, and why."""

    mean_s: float | None
    std_error_s: float | None
    p90_s: float | None
    rollouts: int
    reason: Reason | None = None


def cost_of(
    task: Localization,
    belief: GridBelief,
    measured: Sequence[BearingMeasured],
    platform: tuple[float, float],
    place: tuple[float, float],
    rollouts: int = COST_ROLLOUTS,
) -> Cost:
    """Time until localized when the next bearing is taken at `place` (m ENU)."""
    try:
        found = expected_time_from(
            foreseen_for(task, measured, belief),
            belief,
            task.planner_bearings(measured),
            place,
            task.mission.planner.options,
            platform_xy=platform,
            rollouts=rollouts,
        )
    except PlannerError as error:
        return Cost(None, None, None, 0, error.reason)
    return Cost(found.mean, _finite(found.std_error), in_nine_of_ten(found.times), rollouts)


def in_nine_of_ten(times: FloatArray) -> float | None:
    """Time (s) that nine of ten searches with these simulated times (n,) do not exceed, None without any.

    Simulated flights know of no echo and of no sweep that is taken again: t_90 = NOT_SIMULATED x their 90 % quantile.
    A few lost searches can carry the mean beyond it; then it is the mean, which holds for even more.
    """
    return float(max(NOT_SIMULATED * np.quantile(times, 0.9), times.mean())) if len(times) else None


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _around(place: tuple[float, float]) -> Ring:
    """Eight corners around all that counts as the same place."""
    angles, radius = np.arange(8) * np.pi / 4, SAME_PLACE_M / math.cos(np.pi / 8)
    return np.array(place) + radius * np.column_stack([np.cos(angles), np.sin(angles)])
