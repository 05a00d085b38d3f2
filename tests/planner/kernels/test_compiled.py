"""The compiled kernel does what the readable one says, in every mode, on random problems."""

from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest

from planner.belief.grid import fold
from planner.kernels import compiled, reference
from planner.kernels.model import Outcomes, Tasks, outcomes
from planner.kernels.value.model import NODES, RATIOS, SCALES
from planner.options import Estimator
from planner.policy.actions import constrained_actions
from planner.policy.simulation import simulate
from planner.policy.value_table import ProgramTable, key_of
from planner.sampling import random_paths
from planner.types import (
    Bearing,
    FullMotion,
    GaussianPrior,
    LinearConstantMotion,
    LinearMotion,
    PlannerError,
    Problem,
    RingPrior,
    UniformPrior,
)


def rectangle(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


AREAS = (
    rectangle(0, 0, 300, 300),
    rectangle(-40, 15, 273, 135),
    np.array([[0, 0], [300, 0], [300, 100], [100, 100], [100, 300], [0, 300]], dtype=float),
    np.array([[20, 0], [280, 30], [250, 260], [60, 290]], dtype=float),
)
MOTIONS = (LinearMotion(5.0), LinearConstantMotion(7.0, 11.2), FullMotion())


def random_case(seed: int):
    """(problem, bearings, platform, base policy, horizon, heading): any combination of the kernels' modes."""
    rng = np.random.default_rng(seed)
    area = AREAS[rng.integers(len(AREAS))]
    centre = area.mean(axis=0)
    priors = (
        UniformPrior(),
        GaussianPrior(centre[0], centre[1], np.diag(rng.uniform(8, 60, 2) ** 2)),
        RingPrior(centre[0], centre[1], rng.uniform(5, 40), rng.uniform(60, 150)),
    )
    fixed = rng.random() < 0.5
    low, high = area.min(axis=0) - 60, area.max(axis=0) + 60
    problem = Problem(
        area=(area,),
        sigma=float(np.deg2rad(rng.choice([1.0, 2.5, 4.0, 7.0, 12.0, 25.0]))),
        threshold=float(rng.uniform(3, 15)),
        measurement_time=float(rng.uniform(1, 40)),
        motion=MOTIONS[rng.integers(len(MOTIONS))],
        flight_area=(rectangle(*low, *high),) if fixed or rng.random() < 0.5 else None,
        no_fly=(rectangle(*np.concatenate((centre, centre + 30))),) if fixed and rng.random() < 0.3 else (),
        standoff=float(rng.choice([0.0, 20.0, 50.0])),
        action_grid=(int(rng.integers(3, 21)), int(rng.integers(3, 21))),
        action_spacing=float(rng.uniform(20, 40)) if fixed else None,
        estimator=cast(Estimator, str(rng.choice(["map", "expected_value", "geometric_median"]))),
        prior=priors[rng.integers(3)],
    )
    bearings = []
    for _ in range(rng.integers(0, 3)):
        x, y = rng.uniform(low, high)
        angle = np.arctan2(centre[1] - y, centre[0] - x) + rng.normal(0, problem.sigma)
        bearings.append(Bearing(x, y, float(angle), problem.sigma, float(rng.choice([0.0, 0.05]))))
    heading = None if rng.random() < 0.5 else float(rng.uniform(-np.pi, np.pi))
    policy = str(rng.choice(["ellipse", "fisher", "dynamic_program"]))
    platform, horizon = tuple(rng.uniform(low, high)), int(rng.choice([1, 2, 24]))
    problem = replace(problem, likelihood="resolved" if rng.random() < 0.4 else "centre")
    return problem, bearings, platform, policy, horizon, heading


def made_up_table(problem, seed: int) -> ProgramTable:
    """Seconds that no program computed: kernels must agree on any numbers, and a real table takes half a minute."""
    rng = np.random.default_rng([seed, 1])
    after = problem.measurement_time + rng.uniform(0.0, 30.0, (SCALES, RATIOS, NODES * NODES))
    return ProgramTable(key_of(problem), after)


def both(case, count: int, seed: int) -> tuple[Outcomes, Outcomes]:
    problem, bearings, platform, policy, horizon, heading = case
    belief = fold(problem, bearings)
    program = made_up_table(problem, seed) if policy == "dynamic_program" else None
    simulation = simulate(
        problem, belief, platform, base_policy=policy, horizon=horizon, heading=heading, program=program
    )
    places = constrained_actions(problem, belief)
    actions = simulation.first_actions(places)
    rng = np.random.default_rng(seed)
    paths = random_paths(belief, simulation.rules.sigma, count, horizon, rng)
    tasks = Tasks(rng.integers(0, len(places), count), np.arange(count))
    results = outcomes(count), outcomes(count)
    reference.rollouts(simulation.start, simulation.rules, actions, paths, tasks, results[0])
    compiled.rollouts(simulation.start, simulation.rules, actions, paths, tasks, results[1])
    return results


def disagreements(case, count: int, seed: int) -> int:
    ours, fast = both(case, count, seed)
    same = (
        (ours.bearings == fast.bearings)
        & np.isclose(ours.costs, fast.costs, rtol=1e-9, atol=1e-6)
        & np.isclose(ours.ends, fast.ends, rtol=1e-6, atol=1e-5).all(axis=1)
    )
    return int((~same & np.isfinite(ours.costs)).sum())


def usable(seed: int):
    """The random case of this seed, or None when its bearings contradict each other."""
    case = random_case(seed)
    try:
        fold(case[0], case[1])
    except PlannerError:
        return None
    return case


@pytest.mark.parametrize("seed", range(40))
def test_compiled_is_the_reference(seed):
    case = usable(seed)
    if case is not None:
        assert disagreements(case, 12, seed) == 0


@pytest.mark.long
@pytest.mark.timeout(1800)
def test_compiled_is_the_reference_over_ten_thousand_rollouts():
    wrong, done, seed = 0, 0, 1000
    while done < 10_000:
        seed += 1
        case = usable(seed)
        if case is not None:
            wrong += disagreements(case, 25, seed)
            done += 25
    assert wrong == 0


def scenario_2():
    return Problem(
        area=(AREAS[0],),
        sigma=np.deg2rad(4.0),
        threshold=5.0,
        measurement_time=10.0,
        motion=LinearMotion(5.0),
        prior=GaussianPrior(150.0, 150.0, np.diag([100.0, 1600.0])),
    )


@pytest.mark.parametrize("policy", ["ellipse", "fisher", "dynamic_program"])
def test_compiled_is_the_reference_at_the_first_belief_of_scenario_2(policy):
    assert disagreements((scenario_2(), [], (150.0, 0.0), policy, 24, None), 300, 2) == 0


def test_a_sensor_in_the_middle_of_a_cell_gets_the_same_answer():
    problem = replace(scenario_2(), prior=UniformPrior())
    belief = fold(problem, [])
    simulation = simulate(problem, belief, (150.0, 0.0), base_policy="ellipse")
    actions = simulation.first_actions(np.array([[172.5, 172.5], [151.5, 148.5]]))
    paths = random_paths(belief, problem.sigma, 40, 24, np.random.default_rng(3))
    tasks = Tasks(np.repeat([0, 1], 40), np.tile(np.arange(40), 2))
    ours, fast = outcomes(80), outcomes(80)
    reference.rollouts(simulation.start, simulation.rules, actions, paths, tasks, ours)
    compiled.rollouts(simulation.start, simulation.rules, actions, paths, tasks, fast)
    assert (ours.bearings == fast.bearings).all()
    assert ours.costs == pytest.approx(fast.costs, rel=1e-9)


def test_one_compilation_serves_every_problem():
    for seed in (1, 2, 3):
        case = usable(seed)
        if case is not None:
            both(case, 2, seed)
    assert len(cast(Any, compiled.rollouts).signatures) == 1


def test_two_threads_change_nothing():
    problem = scenario_2()
    belief = fold(problem, [])
    paths = random_paths(belief, problem.sigma, 64, 24, np.random.default_rng(5))
    tasks = Tasks(np.arange(64) % 7, np.arange(64))
    costs = []
    for threads in (1, 2):
        simulation = simulate(problem, belief, (150.0, 0.0), base_policy="ellipse", threads=threads)
        actions = simulation.first_actions(constrained_actions(problem, belief)[:7])
        costs.append(simulation.run(actions, paths, tasks).costs)
    assert (costs[0] == costs[1]).all()
