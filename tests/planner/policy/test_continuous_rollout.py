import numpy as np
import pytest
from refusals import refusing

from planner.belief.grid import prior_belief
from planner.policy.continuous_rollout import ContinuousRollout
from planner.policy.ellipse import ellipse
from planner.reasons import BudgetTooSmall, FixedSamplePaths
from planner.study.action_values import values_of_places
from planner.study.scenarios import scenario


@pytest.mark.parametrize(
    ("selection", "sampling"),
    [("quadrant", "crn"), ("quadrant", "deterministic"), ("sgd", "crn"), ("bfgs", "deterministic")],
)
def test_finds_a_first_place_as_good_as_the_base_policys(selection, sampling):
    case = scenario("2")
    belief = prior_belief(case.problem)
    policy = ContinuousRollout(selection, sampling, "ellipse", budget=1600)
    decision = policy(case.problem, belief, case.platform, np.random.default_rng(3))
    base = ellipse(case.problem, belief, case.platform)
    ours, theirs = values_of_places(case, np.array([[decision.x, decision.y], [base.x, base.y]]), paths=1000)
    assert ours < theirs + 1.0
    assert decision.rollouts <= 1600
    assert sum(c.rollouts for c in decision.candidates) == decision.rollouts


def test_refuses_descents_it_cannot_make():
    case = scenario("2")
    belief = prior_belief(case.problem)
    with refusing(FixedSamplePaths(8)):
        ContinuousRollout("sgd", "deterministic", "ellipse", budget=3600)(
            case.problem, belief, case.platform, np.random.default_rng(0)
        )
    with refusing(BudgetTooSmall(rollouts=28, needed_rollouts=29)):
        ContinuousRollout("quadrant", "crn", "ellipse", budget=28)(
            case.problem, belief, case.platform, np.random.default_rng(0)
        )
