import numpy as np
import pytest

from planner.belief.grid import prior_belief
from planner.policy.continuous_rollout import ContinuousRollout
from planner.policy.ellipse import ellipse
from planner.study.action_values import values_of_places
from planner.study.scenarios import scenario
from planner.types import PlannerError


@pytest.mark.parametrize(
    ("selection", "sampling"),
    [("quadrant", "crn"), ("quadrant", "deterministic"), ("sgd", "crn"), ("bfgs", "deterministic")],
)
def test_finds_a_first_place_as_good_as_the_base_policys(selection, sampling):
    case = scenario("2")
    belief = prior_belief(case.problem)
    policy = ContinuousRollout(selection=selection, sampling=sampling, budget=1600)
    decision = policy(case.problem, belief, case.platform, np.random.default_rng(3))
    base = ellipse(case.problem, belief, case.platform)
    ours, theirs = values_of_places(case, np.array([[decision.x, decision.y], [base.x, base.y]]), paths=1000)
    assert ours < theirs + 1.0
    assert decision.rollouts <= 1600
    assert sum(c.rollouts for c in decision.candidates) == decision.rollouts


def test_refuses_descents_it_cannot_make():
    case = scenario("2")
    belief = prior_belief(case.problem)
    with pytest.raises(PlannerError, match="crn or pmc"):
        ContinuousRollout(selection="sgd", sampling="deterministic")(
            case.problem, belief, case.platform, np.random.default_rng(0)
        )
    with pytest.raises(PlannerError, match="29"):
        ContinuousRollout(selection="quadrant", budget=28)(
            case.problem, belief, case.platform, np.random.default_rng(0)
        )
