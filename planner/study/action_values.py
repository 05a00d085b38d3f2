"""What first actions are really worth: their values on a large, independent set of sample paths."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.belief.grid import GridBelief, prior_belief
from planner.kernels.model import Tasks
from planner.options import STUDY, BasePolicy
from planner.policy.actions import constrained_actions
from planner.policy.simulation import HORIZON, Simulation, simulate
from planner.sampling import random_paths
from planner.study.scenarios import Scenario
from planner.types import FloatArray, Problem

TEST_SEED = 20_190_401
"""Of the paths that values are tested on: no planner's seed."""


@dataclass(frozen=True, slots=True)
class ActionValues:
    """places: (n, 2) m. values, std_errors: (n,) s, of flying there first and following the base policy after."""

    belief: GridBelief
    places: FloatArray
    values: FloatArray
    std_errors: FloatArray


def values_of_grid(scenario: Scenario, paths: int, base_policy: BasePolicy = STUDY.base_policy) -> ActionValues:
    """Of every place of the scenario's action space, at the first decision on the prior."""
    belief = prior_belief(scenario.problem)
    places = constrained_actions(scenario.problem, belief)
    return _valued(belief, _simulation(scenario, belief, base_policy), places, paths)


def values_of_places(
    scenario: Scenario, places: FloatArray, paths: int, base_policy: BasePolicy = STUDY.base_policy
) -> FloatArray:
    """(n,) s of first actions (n, 2), m, all on the same sample paths: their differences are sharper than they are."""
    belief = prior_belief(scenario.problem)
    return _valued(belief, _simulation(scenario, belief, base_policy), places, paths).values


def _simulation(scenario: Scenario, belief: GridBelief, base_policy: BasePolicy) -> Simulation:
    problem: Problem = scenario.problem
    return simulate(problem, belief, scenario.platform, base_policy=base_policy, horizon=HORIZON)


def _valued(belief: GridBelief, simulation: Simulation, places: FloatArray, paths: int) -> ActionValues:
    actions = simulation.first_actions(places)
    pool = random_paths(belief, simulation.rules.sigma, paths, HORIZON, np.random.default_rng(TEST_SEED))
    tasks = Tasks(np.repeat(np.arange(len(places)), paths), np.tile(np.arange(paths), len(places)))
    costs = simulation.run(actions, pool, tasks).costs.reshape(len(places), paths)
    return ActionValues(belief, places, costs.mean(axis=1), costs.std(axis=1, ddof=1) / np.sqrt(paths))
