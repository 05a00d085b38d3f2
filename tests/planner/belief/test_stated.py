"""What is stated agrees with what is claimed, whatever the bearings, the goal and the belief (decision 68)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.belief.estimate import estimate, mass_within
from planner.belief.grid import fold
from planner.belief.joint import joint_prior, update_joint
from planner.belief.moving import Assumed, moving_prior, predicted, update_moving
from planner.belief.verdict import FAR_ERRORS, LINE, MOST_BEYOND, stated, verdict
from planner.movement import WALKING_S, Movement
from planner.reasons import ErrorMayBeFarLarger, ExpectedErrorTooLarge, NoBearingYet
from planner.types import Bearing, InconsistentBearings, LinearMotion, LocalizationRule, Problem

SQUARE = np.array([[0.0, 0.0], [200.0, 0.0], [200.0, 200.0], [0.0, 200.0]])
TARGET = (110.0, 120.0)

places = st.tuples(st.floats(-50.0, 250.0), st.floats(-50.0, 250.0)).filter(
    lambda place: np.hypot(place[0] - TARGET[0], place[1] - TARGET[1]) > 5.0
)
taken = st.lists(st.tuples(places, st.floats(-25.0, 25.0), st.sampled_from([1.5, 5.0, 15.0])), max_size=4)
goals = st.sampled_from([0.5, 3.0, 10.0, 35.0, 200.0])
kinds = st.sampled_from(["plain", "joint", "moving", "later"])
estimators = st.sampled_from(["expected_value", "geometric_median"])


def bearings_of(seen):
    return [
        Bearing(
            x,
            y,
            float(np.arctan2(TARGET[1] - y, TARGET[0] - x) + np.deg2rad(off)),
            float(np.deg2rad(sigma)),
            outlier_probability=0.05,
            taken_at=45.0 * number,
        )
        for number, ((x, y), off, sigma) in enumerate(seen)
    ]


def believed(problem, kind, bearings):
    if kind == "plain":
        return fold(problem, bearings)
    if kind == "joint":
        belief = joint_prior(problem)
        for bearing in bearings:
            belief = update_joint(belief, bearing)
        return belief
    moving = moving_prior(problem, Assumed(Movement(0.4, WALKING_S)))
    for bearing in bearings:
        moving = update_moving(moving, bearing)
    return predicted(moving, 60.0) if kind == "later" else moving


@settings(deadline=None, max_examples=60)
@given(taken, goals, kinds, estimators)
def test_a_claim_states_no_more_than_its_goal_and_what_is_no_claim_for_its_error_no_less(seen, goal, kind, estimator):
    problem = Problem((SQUARE,), 0.09, goal, 10.0, LinearMotion(5.0), estimator=estimator)
    bearings = bearings_of(seen)
    try:
        belief = believed(problem, kind, bearings)
    except InconsistentBearings:
        return
    mean = estimate(belief, estimator)
    said = verdict(problem, LocalizationRule(goal), bearings, belief)
    assert said.estimate is not None
    error = said.estimate.expected_rmse
    assert (said.estimate.x, said.estimate.y) == (mean.x, mean.y)
    assert error == stated(belief, mean, goal).expected_rmse
    assert mean.expected_rmse <= error <= max(mean.expected_rmse * LINE, error_that_is_judged(belief, mean)) + 1e-9
    if said.localized:
        assert error <= goal
        assert 1.0 - mass_within(belief, mean.x, mean.y, FAR_ERRORS * goal) <= MOST_BEYOND or kind == "plain"
    too_large = [one for one in said.reasons if isinstance(one, ExpectedErrorTooLarge)]
    assert [one.expected_error_m for one in too_large] == [error] * len(too_large)
    if any(isinstance(one, ExpectedErrorTooLarge | ErrorMayBeFarLarger) for one in said.reasons):
        assert error >= goal
    elif not any(isinstance(one, NoBearingYet) for one in said.reasons):
        assert error <= goal, "nothing is held against the error, and it is beyond the goal"


def error_that_is_judged(belief, mean):
    """What is stated where no goal leaves room for more: m."""
    return stated(belief, mean, 0.0).expected_rmse


@settings(deadline=None, max_examples=20)
@given(taken, kinds)
def test_the_larger_the_goal_the_more_is_stated_up_to_what_a_line_asks(seen, kind):
    problem = Problem((SQUARE,), 0.09, 10.0, 10.0, LinearMotion(5.0))
    try:
        belief = believed(problem, kind, bearings_of(seen))
    except InconsistentBearings:
        return
    mean = estimate(belief, problem.estimator)
    errors = [stated(belief, mean, goal).expected_rmse for goal in (0.5, 3.0, 10.0, 35.0, 200.0, np.inf)]
    assert errors == sorted(errors)
    most = max(errors[0], LINE * mean.expected_rmse) if kind != "plain" else mean.expected_rmse
    assert errors[-1] == pytest.approx(most)
