"""`crossfix bench`: how fast the planner is on this machine."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Annotated, Any

import numpy as np
import typer

from backend.cli.edge import print_json
from planner.belief.grid import GridBelief, prior_belief
from planner.kernels.model import Tasks
from planner.options import STUDY
from planner.plan import plan
from planner.policy.actions import action_space
from planner.policy.simulation import KernelName, simulate
from planner.sampling import random_paths
from planner.study.scenarios import Scenario, scenario

BUDGETS = (400, 1000, 1600, 3600, 6400, 12800, 25600)
ROLLOUTS: dict[KernelName, int] = {"reference": 40, "compiled": 4000}


def bench(
    repeats: Annotated[int, typer.Option(min=1, max=100, help="Each figure is the median of this many runs.")] = 5,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Time one rollout and one plan at the first belief of the thesis' Scenario 2 (medium, 20 x 20 places).

    rollout_us: microseconds a rollout. ratio: reference / compiled on one thread. plan_ms: milliseconds a decision with
    that many rollouts on two threads.

    Example: crossfix bench --json
    """
    result = measured(repeats)
    if json_:
        print_json(result)
        return
    for name, value in result["rollout_us"].items():
        typer.echo(f"one rollout, {name.replace('_', ' ')}: {value:.1f} us")
    typer.echo(f"compiled on one thread is {result['ratio']:.0f} times as fast as the reference")
    for budget, value in result["plan_ms"].items():
        typer.echo(f"one plan, {budget} rollouts: {value:.1f} ms")


def measured(repeats: int) -> dict[str, Any]:
    """What `--json` prints."""
    case = scenario("2")
    belief = prior_belief(case.problem)
    rollout_us = {
        "reference": _rollout_us(case, belief, "reference", 1, repeats),
        "compiled_1_thread": _rollout_us(case, belief, "compiled", 1, repeats),
        "compiled_2_threads": _rollout_us(case, belief, "compiled", 2, repeats),
    }
    return {
        "rollout_us": rollout_us,
        "ratio": rollout_us["reference"] / rollout_us["compiled_1_thread"],
        "plan_ms": {str(budget): _plan_ms(case, belief, budget, repeats) for budget in BUDGETS},
        "repeats": repeats,
    }


def _rollout_us(case: Scenario, belief: GridBelief, kernel: KernelName, threads: int, repeats: int) -> float:
    """Rollouts spread evenly over the first actions, on common random paths; the first run warms up."""
    simulation = simulate(
        case.problem, belief, case.platform, base_policy=STUDY.base_policy, kernel=kernel, threads=threads
    )
    actions = simulation.first_actions(action_space(case.problem, belief))
    count = ROLLOUTS[kernel]
    paths = random_paths(belief, case.problem.sigma, count, simulation.rules.horizon, np.random.default_rng(1))
    tasks = Tasks(np.arange(count) * len(actions.costs) // count, np.arange(count))
    return 1e6 * _median_s(lambda: simulation.run(actions, paths, tasks), repeats) / count


def _plan_ms(case: Scenario, belief: GridBelief, budget: int, repeats: int) -> float:
    def decide() -> None:
        plan(case.problem, belief, (), case.platform, replace(STUDY, budget=budget), threads=2)

    return 1e3 * _median_s(decide, repeats)


def _median_s(work: Callable[[], object], repeats: int) -> float:
    work()
    times: list[float] = []
    for _ in range(repeats):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return statistics.median(times)
