"""The planner's front door: where to measure next, and how long the search will take.

Synchronous and pure; the compiled kernel releases the interpreter lock, so that a server calls these in a thread.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from planner.belief.grid import GridBelief, prior_belief
from planner.belief.joint import joint_prior, update_joint
from planner.kernels.crossing import meetings
from planner.kernels.model import Tasks
from planner.legs import first_time
from planner.options import FIELD, PlannerOptions
from planner.policy.claim_ahead import ClaimAhead, claim_ahead
from planner.policy.dynamic_program import stands_on
from planner.policy.rollout import SELECTIONS, Rollout, claim_after
from planner.policy.simulation import HORIZON, KernelName, TerminalValue, simulate
from planner.reasons import BeliefOutOfStep, NoWay, UnusableNumber
from planner.sampling import random_paths
from planner.types import Bearing, Decision, FloatArray, LinearMotion, PlannerError, Problem


@dataclass(frozen=True, slots=True)
class ExpectedTime:
    """Time until localization, s: mean with its standard error, median, 90 % quantile, the samples (n,).

    bearings: mean number still to be taken. localized_share: of the simulated flights that reached the threshold
    before their horizon; below 1 the times are lower bounds. by_claim: by the chance of a claim (claim_ahead), not by
    rollouts.
    """

    mean: float
    std_error: float
    median: float
    p90: float
    bearings: float
    localized_share: float
    times: FloatArray
    by_claim: bool = False


def plan(
    problem: Problem,
    belief: GridBelief,
    bearings: Sequence[Bearing],
    platform_xy: tuple[float, float],
    options: PlannerOptions = FIELD,
    *,
    threads: int = 2,
    heading: float | None = None,
    horizon: int = HORIZON,
    terminal: TerminalValue | None = None,
    without: Sequence[tuple[float, float]] = (),
    kernel: KernelName = "compiled",
) -> Decision:
    """The next place to measure from, by policy rollout.

    bearings: those folded into the belief (their number seeds this decision apart from the others). platform_xy: m
    ENU. options: `method` and `estimator` do not count, the estimator is the problem's. heading: rad ccw from
    east, matters to the full motion model only. without: places (m ENU) that the operator refused. Raises PlannerError
    when no place is allowed or reachable.
    """
    _check(belief, bearings, options.budget)
    policy = Rollout(
        selection=SELECTIONS[options.selection],
        sampling=options.sampling,
        base_policy=options.base_policy,
        budget=options.budget,
        threads=threads,
        horizon=horizon,
        kernel=kernel,
        terminal=terminal,
        heading=heading,
        without=without,
    )
    return policy(problem, belief, platform_xy, np.random.default_rng([options.seed, len(bearings)]))


def expected_time_from(
    problem: Problem,
    belief: GridBelief,
    bearings: Sequence[Bearing],
    xy: tuple[float, float],
    options: PlannerOptions = FIELD,
    *,
    platform_xy: tuple[float, float] | None = None,
    rollouts: int = 200,
    threads: int = 1,
    heading: float | None = None,
    horizon: int = HORIZON,
    kernel: KernelName = "compiled",
) -> ExpectedTime:
    """Time until localization when the next bearing is taken at xy (m ENU), then the base policy followed.

    By the measure that `plan` chooses by: where the rollout method looks one bearing ahead for a claim
    (planner.policy.claim_ahead), so does this. options: `method`, `base_policy` and `seed` matter. platform_xy: where
    the flight to xy starts; None: the platform is there already. The sample paths depend on seed and number of bearings
    only, so that places compare on equal luck. PlannerError when xy cannot be reached.
    """
    _check(belief, bearings, rollouts)
    followed, program = stands_on(problem, options.base_policy)
    simulation = simulate(
        problem,
        belief,
        xy if platform_xy is None else platform_xy,
        base_policy=followed,
        heading=heading,
        horizon=horizon,
        threads=threads,
        kernel=kernel,
        program=program,
    )
    actions = simulation.first_actions(np.array([xy], dtype=float))
    if platform_xy is None:
        actions.costs[0] = first_time(problem)
    if not np.isfinite(actions.costs[0]):
        raise PlannerError(NoWay(float(np.hypot(*(actions.places[0] - simulation.platform)))))
    ahead = claim_after(problem, belief, simulation) if options.method == "rollout" else None
    if ahead is not None:
        return _by_claim(ahead, actions.places, float(actions.costs[0]), rollouts)
    rng = np.random.default_rng([options.seed, len(bearings)])
    paths = random_paths(belief, simulation.rules.sigma, rollouts, horizon, rng)
    tasks = Tasks(np.zeros(rollouts, dtype=np.int64), np.arange(rollouts))
    out = simulation.run(actions, paths, tasks)
    return ExpectedTime(
        mean=float(out.costs.mean()),
        std_error=float(out.costs.std(ddof=1) / np.sqrt(rollouts)) if rollouts > 1 else float("nan"),
        median=float(np.median(out.costs)),
        p90=float(np.quantile(out.costs, 0.9)),
        bearings=float(out.bearings.mean()),
        localized_share=float(out.ends[:, 9].mean()),
        times=out.costs,
    )


def _by_claim(ahead: ClaimAhead, place: FloatArray, cost: float, paths: int) -> ExpectedTime:
    """place: (1, 2) m. cost: s, of flying there and measuring."""
    chance = ahead.chance_from(place)
    times = ahead.times(cost, float(chance[0]), paths)
    return ExpectedTime(
        mean=float(times.mean()),
        std_error=float(ahead.std_errors(chance)[0]),
        median=float(np.median(times)),
        p90=float(np.quantile(times, 0.9)),
        bearings=1.0 + float((times - cost).mean()) / ahead.again,
        localized_share=1.0,
        times=times,
        by_claim=True,
    )


def _check(belief: GridBelief, bearings: Sequence[Bearing], budget: int) -> None:
    if budget < 1:
        raise PlannerError(UnusableNumber("budget", "at_least_one", str(budget)))
    if belief.bearings != len(bearings):
        raise PlannerError(BeliefOutOfStep(belief.bearings, len(bearings)))


def warm_up() -> None:
    """Load (the first time: compile) the kernels, so that the first plan of a mission does not wait for them."""
    square = np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 30.0], [0.0, 30.0]])
    problem = Problem((square,), sigma=0.1, threshold=5.0, measurement_time=1.0, motion=LinearMotion(5.0))
    plan(problem, prior_belief(problem), (), (0.0, 0.0), replace(FIELD, budget=16), threads=1)
    once = update_joint(joint_prior(problem), Bearing(0.0, 0.0, 0.5, problem.sigma))
    near, here = replace(problem, threshold=100.0), np.zeros(2)
    claim_ahead(near, once, here, lambda: np.array([[0.0, 30.0]]), lambda places: np.ones(len(places)))
    meetings(square, square, (square,))
