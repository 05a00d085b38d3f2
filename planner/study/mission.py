"""Flies one simulated mission: decide, fly, measure, update, until localized."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.belief.estimate import confidence_region, estimate
from planner.belief.grid import GridBelief, prior_belief, update
from planner.geometry import distance_to_convex
from planner.motion import flight_time, turn_between
from planner.observation import expected_bearing, wrap
from planner.policy.route import RoutePolicy
from planner.policy.types import Policy
from planner.sampling import random_noise
from planner.study.scenarios import Scenario
from planner.types import Bearing, Decision, FloatArray

MOST_BEARINGS = 100
"""A mission that is not localized by then ends unlocalized and counts with the time it took."""


@dataclass(frozen=True, slots=True)
class Mission:
    """What came of one run. Times s, lengths m, first_* the first decided place (NaN when none was needed).

    index: of the target in its series. planning_rollouts: sample paths used. best_value: the chosen first action's
    value as the planner estimated it, NaN for planners that do not.
    """

    run: int
    index: int
    time: float
    travel: float
    bearings: int
    localized: bool
    error: float
    expected_rmse: float
    in_c95: bool
    target_x: float
    target_y: float
    first_x: float
    first_y: float
    best_value: float
    planning_rollouts: int


@dataclass(frozen=True, slots=True)
class Opening:
    """What all missions of a scenario have in common: the prior, and the first decision when it is always the same."""

    belief: GridBelief
    decision: Decision | None
    route: FloatArray | None


def opening(scenario: Scenario, policy: Policy, *, repeatable: bool) -> Opening:
    """Prior of the scenario; with `repeatable` the policy uses no chance, so its answer to the prior is kept."""
    belief = prior_belief(scenario.problem)
    if scenario.bearing_at_start or not repeatable:
        return Opening(belief, None, None)
    if isinstance(policy, RoutePolicy):
        return Opening(belief, None, policy.route(scenario.problem, belief, scenario.platform))
    return Opening(belief, policy(scenario.problem, belief, scenario.platform, np.random.default_rng(0)), None)


def fly(scenario: Scenario, policy: Policy, start: Opening, run: int, seed: int) -> Mission:
    """One mission. Target and bearing noise depend on (seed, run) only: common random numbers for all policies."""
    problem = scenario.problem
    chance = [np.random.default_rng([seed, run, stream]) for stream in range(3)]
    target = scenario.target(run, chance[0])
    noise = random_noise(problem.sigma, (MOST_BEARINGS,), chance[1])
    belief, here = start.belief, np.array(scenario.platform)
    time = travel = 0.0
    heading: float | None = None
    bearings = rollouts = 0
    first = np.full(2, np.nan)
    best_value = np.nan
    queue: list[FloatArray] = [here] if scenario.bearing_at_start else []
    while True:
        estimated = estimate(belief, problem.estimator)
        if estimated.expected_rmse < problem.threshold or bearings == MOST_BEARINGS:  # (4.11)
            break
        if not queue:
            decided = _decide(scenario, policy, start, belief, here, chance[2], at_start=bearings == 0)
            queue = decided.places
            rollouts += decided.rollouts
            if np.isnan(first[0]):
                first, best_value = queue[0], decided.value
        place = queue.pop(0)
        leg = float(np.hypot(*(place - here)))
        if leg > 0:
            direction = float(np.arctan2(*(place - here)[::-1]))
            turn = np.pi / 2 if heading is None else float(turn_between(heading, direction))
            time += float(flight_time(problem.motion, leg, turn))
            heading = direction
        time += problem.measurement_time
        travel += leg
        here = place
        angle = float(wrap(expected_bearing(here[0], here[1], target[0], target[1]) + noise[bearings]))
        belief = update(belief, Bearing(float(here[0]), float(here[1]), angle, problem.sigma), problem.likelihood)
        bearings += 1
    return Mission(
        run=run,
        index=scenario.index(run),
        time=time,
        travel=travel,
        bearings=bearings,
        localized=bool(estimated.expected_rmse < problem.threshold),
        error=float(np.hypot(estimated.x - target[0], estimated.y - target[1])),
        expected_rmse=estimated.expected_rmse,
        in_c95=bool(distance_to_convex(target[None], confidence_region(belief))[0] <= 0),
        target_x=float(target[0]),
        target_y=float(target[1]),
        first_x=float(first[0]),
        first_y=float(first[1]),
        best_value=float(best_value),
        planning_rollouts=rollouts,
    )


@dataclass(frozen=True, slots=True)
class _Decided:
    places: list[FloatArray]
    rollouts: int
    value: float


def _decide(
    scenario: Scenario,
    policy: Policy,
    start: Opening,
    belief: GridBelief,
    here: FloatArray,
    rng: np.random.Generator,
    *,
    at_start: bool,
) -> _Decided:
    platform = (float(here[0]), float(here[1]))
    if isinstance(policy, RoutePolicy):
        kept = start.route if at_start else None
        route = policy.route(scenario.problem, belief, platform) if kept is None else kept
        return _Decided(list(route), 0, np.nan)
    kept = start.decision if at_start else None
    decision = policy(scenario.problem, belief, platform, rng) if kept is None else kept
    value = float(decision.times.mean()) if len(decision.times) else np.nan
    return _Decided([np.array([decision.x, decision.y])], decision.rollouts, value)
