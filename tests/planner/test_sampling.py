"""Sample paths: drawn from the belief, equal in mass, reproducible."""

import numpy as np
import pytest
from refusals import refusing

from planner.belief.grid import prior_belief
from planner.reasons import UnusableNumber
from planner.sampling import (
    QUASI_DIMENSIONS,
    deterministic_paths,
    equal_mass_points,
    normal_quantile,
    quasi_random_paths,
    random_noise,
    random_paths,
    random_targets,
    sobol,
    targets_at,
)
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


def test_sobol_points_are_those_of_scipy():
    from scipy.stats import qmc

    wanted = qmc.Sobol(QUASI_DIMENSIONS, scramble=False, bits=30).random(256)
    assert (sobol(0, 256, QUASI_DIMENSIONS) == wanted).all()
    assert (sobol(64, 64, QUASI_DIMENSIONS) == wanted[64:128]).all()


def test_normal_quantiles_are_those_of_scipy():
    from scipy.special import ndtri

    share = np.linspace(0.0005, 0.9995, 301)
    assert normal_quantile(share) == pytest.approx(ndtri(share), abs=1e-5)
    cut = normal_quantile(np.array([0.0, 0.5, 1.0]), cut=3.0)
    assert cut == pytest.approx([-3.0, 0.0, 3.0], abs=1e-4)


def test_quasi_random_targets_share_the_mass_out_more_evenly_than_chance():
    prior = belief(GAUSSIAN)
    targets = targets_at(prior, sobol(0, 1024, 2) + 0.5 / 1024)
    assert targets.mean(axis=0) == pytest.approx([150.0, 140.0], abs=0.2)
    assert np.cov(targets.T) == pytest.approx(GAUSSIAN.covariance, rel=0.02)
    flat = targets_at(belief(), sobol(0, 256, 2))
    per_sixteenth = np.histogram2d(*flat.T, bins=4, range=((0, 300), (0, 300)))[0]
    assert (per_sixteenth == 16).all()


def test_quasi_random_targets_stay_in_cells_that_hold_mass():
    half = belief()
    half.density[:, :50] = 0.0
    half.density[50:, 50:] = 0.0
    last = 1.0 - 1e-9
    edges = np.array([[0.0, 0.0], [0.0, last], [last, 0.0], [last, last], [0.5, 0.5]])
    targets = targets_at(half, edges)
    assert (targets >= [150.0, 0.0]).all()
    assert (targets <= [300.0, 150.0]).all()
    assert targets[0] == pytest.approx([150.0, 0.0])


def test_quasi_random_paths_go_on_where_they_were_left():
    shift = np.full(QUASI_DIMENSIONS, 0.3)
    whole = quasi_random_paths(belief(), 0.07, 0, 128, 5, shift, np.random.default_rng(1))
    second = quasi_random_paths(belief(), 0.07, 64, 64, 5, shift, np.random.default_rng(2))
    assert (whole.targets[64:] == second.targets).all()
    assert (whole.noise[64:, :2] == second.noise[:, :2]).all()
    assert np.abs(whole.noise).max() <= 0.21 + 1e-9
    assert whole.noise[:, 0].std() == pytest.approx(0.07 * 0.9866, rel=0.02)


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
