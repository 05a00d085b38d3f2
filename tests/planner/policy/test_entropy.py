from dataclasses import replace

import numpy as np
import pytest

from planner.belief.grid import prior_belief, update
from planner.policy.entropy import Entropy, entpp, entpp8
from planner.reasons import LeastEntropy
from planner.sampling import equal_mass_points
from planner.study.scenarios import scenario
from planner.types import Bearing


@pytest.fixture
def narrow():
    """Scenario 2 after one bearing from the south: a long belief along x = 150."""
    case = scenario("2")
    return case.problem, update(prior_belief(case.problem), Bearing(150.0, 0.0, np.pi / 2, case.problem.sigma))


@pytest.mark.parametrize("policy", [entpp, entpp8])
def test_the_chosen_bearing_leaves_less_entropy_than_most(narrow, policy):
    """Against the filter itself: the belief after the expected bearings from the choice and from random places."""
    problem, belief = narrow
    aims = equal_mass_points(belief, policy.samples)

    def entropy_after(x, y):
        entropies = []
        for aim in aims:
            posterior = update(belief, Bearing(x, y, float(np.arctan2(aim[1] - y, aim[0] - x)), problem.sigma))
            mass = posterior.density[posterior.density > 0]
            entropies.append(-(mass @ np.log(mass / posterior.h**2)))
        return np.mean(entropies)

    decision = policy(problem, belief, (150.0, 0.0))
    rng = np.random.default_rng(0)
    others = [entropy_after(*place) for place in rng.uniform(0, 300, (60, 2))]
    assert entropy_after(decision.x, decision.y) < np.quantile(others, 0.05)


def test_grid_and_constraints_are_respected(narrow):
    problem, belief = narrow
    hole = np.array([[100.0, 100.0], [200.0, 100.0], [200.0, 200.0], [100.0, 200.0]])
    decision = Entropy(grid=(12, 12))(replace(problem, no_fly=(hole,)), belief, (150.0, 0.0))
    assert not (100 < decision.x < 200 and 100 < decision.y < 200)
    assert isinstance(decision.reason, LeastEntropy)
    assert decision.reason.places < 144
