"""Sample paths: drawn from the belief, equal in mass, reproducible."""

import numpy as np
import pytest
from refusals import refusing

from planner.belief.grid import prior_belief
from planner.reasons import UnusableNumber
from planner.sampling import deterministic_paths, equal_mass_points, random_noise, random_paths, random_targets
from planner.types import GaussianPrior, LinearMotion, Problem

SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]])


def belief(prior=None):
    problem = Problem((SQUARE,), sigma=0.07, threshold=5.0, measurement_time=10.0, motion=LinearMotion(5.0))
    if prior is not None:
        problem = Problem((SQUARE,), 0.07, 5.0, 10.0, LinearMotion(5.0), prior=prior)
    return prior_belief(problem)


GAUSSIAN = GaussianPrior(150.0, 140.0, np.array([[400.0, 150.0], [150.0, 900.0]]))


def test_random_targets_have_the_beliefs_moments():
    targets = random_targets(belief(GAUSSIAN), 40_000, np.random.default_rng(1))
    assert targets.mean(axis=0) == pytest.approx([150.0, 140.0], abs=0.6)
    assert np.cov(targets.T) == pytest.approx(GAUSSIAN.covariance, rel=0.06)


def test_random_targets_stay_in_cells_that_hold_mass():
    targets = random_targets(belief(), 1000, np.random.default_rng(2))
    assert ((targets >= 0) & (targets <= 300)).all()


def test_noise_is_drawn_again_beyond_three_sigma():
    noise = random_noise(0.1, (200, 200), np.random.default_rng(3))
    assert np.abs(noise).max() <= 0.3
    assert noise.std() == pytest.approx(0.1 * 0.9866, rel=0.01)


def test_the_same_generator_gives_the_same_paths():
    one, two = (random_paths(belief(), 0.1, 50, 4, np.random.default_rng(7)) for _ in range(2))
    assert (one.targets == two.targets).all()
    assert (one.noise == two.noise).all()


def test_two_equal_mass_points_split_along_x_first():
    points = equal_mass_points(belief(), 2)
    assert points == pytest.approx(np.array([[75.0, 150.0], [225.0, 150.0]]))


def test_four_equal_mass_points_split_along_y_next():
    points = equal_mass_points(belief(), 4)
    expected = [[75.0, 75.0], [75.0, 225.0], [225.0, 75.0], [225.0, 225.0]]
    assert np.array(sorted(map(tuple, points.round(6)))) == pytest.approx(np.array(expected))


@pytest.mark.parametrize("count", [1, 2, 8, 64])
def test_equal_mass_points_keep_the_mean_and_never_widen_the_belief(count):
    points = equal_mass_points(belief(GAUSSIAN), count)
    assert points.shape == (count, 2)
    assert points.mean(axis=0) == pytest.approx([150.0, 140.0], abs=0.5)
    assert np.trace(np.cov(points.T, bias=True).reshape(2, 2) if count > 1 else np.zeros((2, 2))) <= 1300.0


def test_deterministic_paths_hear_no_noise():
    paths = deterministic_paths(belief(), 8, 5)
    assert paths.noise.shape == (8, 5)
    assert not paths.noise.any()


@pytest.mark.parametrize("count", [0, 3, 12])
def test_deterministic_paths_need_a_power_of_two(count):
    with refusing(UnusableNumber("paths", "power_of_two", str(count))):
        deterministic_paths(belief(), count, 5)
