import numpy as np
import pytest
from scipy.optimize import check_grad

from planner.belief.grid import prior_belief
from planner.policy.lookahead import (
    RATIOS,
    Course,
    Lookahead,
    fisher_information,
    log_determinant,
    myopic_headings,
    optimal_headings,
    places,
    stationary_course,
)
from planner.study.scenarios import scenario


def two_platforms(**changes):
    return Course(
        starts=np.array([[0.0, 0.0], [10.0, 3.0]]),
        step=5.0,
        steps=4,
        target=np.array([60.0, 20.0]),
        sigma=0.07,
        velocity=np.array([1.0, 2.0]),
        information=np.eye(2) * 1e-3,
        **changes,
    )


def turned(course, headings, angle):
    """The same situation seen in a frame turned by `angle`."""
    c, s = np.cos(angle), np.sin(angle)
    rotation = np.array([[c, -s], [s, c]])
    moved = Course(
        starts=course.starts @ rotation.T,
        step=course.step,
        steps=course.steps,
        target=rotation @ course.target,
        sigma=course.sigma,
        velocity=rotation @ course.velocity,
        information=rotation @ course.information @ rotation.T,
    )
    return moved, headings + angle


@pytest.mark.parametrize("bearing_at_start", [True, False])
def test_gradient_is_the_derivative(bearing_at_start):
    course = two_platforms(bearing_at_start=bearing_at_start)
    headings = np.random.default_rng(0).uniform(-3, 3, (2, 4))
    error = check_grad(
        lambda flat: log_determinant(course, flat.reshape(2, 4))[0],
        lambda flat: log_determinant(course, flat.reshape(2, 4))[1].ravel(),
        headings.ravel(),
    )
    assert error < 1e-5


def test_determinant_is_that_of_the_information():
    course = two_platforms()
    headings = np.random.default_rng(1).uniform(-3, 3, (2, 4))
    information = course.information.copy()
    for way in places(course, headings):
        for k, place in enumerate(way):
            x, y = course.target + k * course.velocity - place
            r4 = (x**2 + y**2) ** 2
            information += np.array([[y * y, -x * y], [-x * y, x * x]]) / (r4 * course.sigma**2)
    np.testing.assert_allclose(fisher_information(course, headings), information, rtol=1e-6)
    assert log_determinant(course, headings)[0] == pytest.approx(np.log(np.linalg.det(information)), rel=1e-6)


def test_turning_the_scene_changes_nothing():
    course = two_platforms()
    headings = np.random.default_rng(2).uniform(-3, 3, (2, 4))
    moved, moved_headings = turned(course, headings, 1.1)
    assert log_determinant(moved, moved_headings)[0] == pytest.approx(log_determinant(course, headings)[0])


@pytest.mark.parametrize("ratio", RATIOS)
def test_optimal_course_beats_chance_and_the_myopic_one(ratio):
    course = stationary_course(ratio, steps=8)
    best = log_determinant(course, optimal_headings(course))[0]
    rng = np.random.default_rng(0)
    chance = max(log_determinant(course, rng.uniform(-1.5, 1.5, (1, 8)))[0] for _ in range(200))
    assert best >= chance
    assert best >= log_determinant(course, myopic_headings(course))[0] - 1e-6


def test_longer_paths_turn_more_toward_the_target():
    """Fig. 3.9: a short path goes across the line of sight, a long one nearly straight at the target."""
    first = []
    for ratio in RATIOS:
        heading = optimal_headings(stationary_course(ratio))[0, 0]
        first.append(abs((heading + np.pi) % (2 * np.pi) - np.pi))
    assert (np.diff(first) < 0).all()
    assert first[0] > np.deg2rad(30)
    assert first[-1] < np.deg2rad(2)


def test_two_platforms_part_to_either_side():
    course = Course(starts=np.zeros((2, 2)), step=0.05, steps=10, target=np.array([1.0, 0.0]), sigma=0.02, closest=0.02)
    ends = places(course, optimal_headings(course))[:, -1]
    assert ends[0, 1] * ends[1, 1] < 0
    assert abs(ends[0, 1]) == pytest.approx(abs(ends[1, 1]), abs=0.02)


def test_a_moving_target_is_led():
    still = stationary_course(0.5)
    moving = Course(
        starts=still.starts,
        step=still.step,
        steps=still.steps,
        target=still.target,
        sigma=still.sigma,
        velocity=np.array([0.0, 0.02]),
        closest=still.closest,
    )
    planned = log_determinant(moving, optimal_headings(moving))[0]
    unaware = log_determinant(moving, optimal_headings(still))[0]
    assert planned > unaware + 0.1


def test_policy_steps_so_far_and_no_further():
    case = scenario("2")
    belief = prior_belief(case.problem)
    decision = Lookahead(steps=3, step=40.0)(case.problem, belief, (150.0, 20.0))
    assert np.hypot(decision.x - 150.0, decision.y - 20.0) == pytest.approx(40.0)


def test_refuses_a_course_without_steps():
    with pytest.raises(ValueError, match="at least one step"):
        Course(starts=np.zeros((1, 2)), step=1.0, steps=0, target=np.ones(2), sigma=0.1)
