"""The planner's front door: where to measure next, and how long the search will take.

Synchronous and pure; the compiled kernel releases the interpreter lock, so that a server calls these in a thread.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from planner.belief.grid import GridBelief, prior_belief
from planner.kernels.crossing import meetings
from planner.kernels.model import Tasks
from planner.policy.rollout import Rollout
from planner.policy.simulation import HORIZON, BasePolicy, KernelName, TerminalValue, simulate
from planner.sampling import Sampling, random_paths
from planner.selection.sequential_halving import sequential_halving
from planner.selection.types import Selection
from planner.selection.uniform import uniform
from planner.types import Bearing, Decision, FloatArray, LinearMotion, PlannerError, Problem

SelectionName = Literal["sequential_halving", "uniform"]
_SELECTIONS: dict[str, Selection] = {"sequential_halving": sequential_halving, "uniform": uniform}


@dataclass(frozen=True, slots=True)
class ExpectedTime:
    """Time until localization, s: mean with its standard error, median, 90 % quantile, the samples (n,).

    bearings: mean number still to be taken. localized_share: of the simulated flights that reached the threshold
    before their horizon; below 1 the times are lower bounds.
    """

    mean: float
    std_error: float
    median: float
    p90: float
    bearings: float
    localized_share: float
    times: FloatArray


def plan(
    problem: Problem,
    belief: GridBelief,
    bearings: Sequence[Bearing],
    platform_xy: tuple[float, float],
    *,
    selection: SelectionName = "sequential_halving",
    sampling: Sampling = "crn",
    base_policy: BasePolicy = "fisher",
    budget: int = 1000,
    seed: int = 1,
    threads: int = 2,
    heading: float | None = None,
    horizon: int = HORIZON,
    terminal: TerminalValue | None = None,
    without: Sequence[tuple[float, float]] = (),
    kernel: KernelName = "compiled",
) -> Decision:
    """The next place to measure from, by policy rollout.

    bearings: those folded into the belief (their number seeds this decision apart from the others). platform_xy: m
    ENU. seed: the same inputs and seed give the same decision. heading: rad ccw from east, matters to the full motion
    model only. without: places the operator refused. Raises PlannerError when no place is allowed or reachable.
    """
    if selection not in _SELECTIONS:
        raise PlannerError(f"selection must be one of {sorted(_SELECTIONS)}, got {selection!r}")
    _check(belief, bearings, budget)
    policy = Rollout(
        selection=_SELECTIONS[selection],
        sampling=sampling,
        base_policy=base_policy,
        budget=budget,
        threads=threads,
        horizon=horizon,
        kernel=kernel,
        terminal=terminal,
        heading=heading,
        without=without,
    )
    return policy(problem, belief, platform_xy, np.random.default_rng([seed, len(bearings)]))


def expected_time_from(
    problem: Problem,
    belief: GridBelief,
    bearings: Sequence[Bearing],
    xy: tuple[float, float],
    *,
    platform_xy: tuple[float, float] | None = None,
    base_policy: BasePolicy = "fisher",
    rollouts: int = 200,
    seed: int = 1,
    threads: int = 1,
    heading: float | None = None,
    horizon: int = HORIZON,
    kernel: KernelName = "compiled",
) -> ExpectedTime:
    """Time until localization when the next bearing is taken at xy (m ENU), then the base policy followed.

    platform_xy: where the flight to xy starts; None: the platform is there already. The sample paths depend on seed
    and number of bearings only, so that places compare on equal luck. PlannerError when xy cannot be reached.
    """
    _check(belief, bearings, rollouts)
    simulation = simulate(
        problem,
        belief,
        xy if platform_xy is None else platform_xy,
        base_policy=base_policy,
        heading=heading,
        horizon=horizon,
        threads=threads,
        kernel=kernel,
    )
    actions = simulation.first_actions(np.array([xy], dtype=float))
    if platform_xy is None:
        actions.costs[0] = problem.measurement_time
    if not np.isfinite(actions.costs[0]):
        raise PlannerError("this place cannot be reached without crossing a no-fly area or the fence")
    rng = np.random.default_rng([seed, len(bearings)])
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


def _check(belief: GridBelief, bearings: Sequence[Bearing], budget: int) -> None:
    if budget < 1:
        raise PlannerError(f"the budget must be at least one rollout, got {budget}")
    if belief.bearings != len(bearings):
        raise PlannerError(f"the belief holds {belief.bearings} bearings, but {len(bearings)} were given: fold them")


def warm_up() -> None:
    """Load (the first time: compile) the kernels, so that the first plan of a mission does not wait for them."""
    square = np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 30.0], [0.0, 30.0]])
    problem = Problem((square,), sigma=0.1, threshold=5.0, measurement_time=1.0, motion=LinearMotion(5.0))
    plan(problem, prior_belief(problem), (), (0.0, 0.0), budget=16, threads=1)
    meetings(square, square, (square,))
