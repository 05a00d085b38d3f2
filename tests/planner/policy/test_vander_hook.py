from dataclasses import replace

import numpy as np
import pytest

from planner.belief.estimate import estimate
from planner.belief.grid import prior_belief
from planner.policy.vander_hook import CautiousGreedy, vander_hook
from planner.study.scenarios import scenario
from planner.types import GaussianPrior


@pytest.mark.parametrize("platform", [(20.0, 40.0), (280.0, 250.0)])
@pytest.mark.parametrize("angle", [0.3, 1.2, 2.5])
def test_stands_on_the_minor_axis_at_three_deviations_on_the_platforms_side(platform, angle):
    c, s = np.cos(angle), np.sin(angle)
    axes = np.array([[c, -s], [s, c]])
    prior = GaussianPrior(150.0, 150.0, axes @ np.diag([1600.0, 100.0]) @ axes.T)
    problem = replace(scenario("2").problem, prior=prior, estimator="expected_value")
    belief = prior_belief(problem)
    look = estimate(belief, "expected_value")
    decision = vander_hook(problem, belief, platform)
    offset = np.array([decision.x - look.x, decision.y - look.y])
    assert abs(offset @ axes[:, 0]) < 0.5
    assert np.hypot(*offset) == pytest.approx(30.0, rel=0.02)
    assert (offset @ axes[:, 1]) * ((np.array(platform) - [look.x, look.y]) @ axes[:, 1]) > 0


def test_a_forbidden_place_gives_way_to_the_nearest_feasible_one():
    problem = replace(scenario("2").problem, flight_area=(np.array([[0.0, 0], [300, 0], [300, 100], [0, 100]]),))
    belief = prior_belief(problem)
    decision = CautiousGreedy()(problem, belief, (150.0, 0.0))
    assert 90.0 < decision.y <= 100.0
