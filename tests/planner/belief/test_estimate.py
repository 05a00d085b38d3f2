"""Estimates of a belief: which point, how spread, and that the geometric median minimizes the expected RMSE."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from planner.belief.estimate import (
    HEAVY_POINTS,
    MEDIAN_STEPS,
    confidence_region,
    estimate,
    geometric_median,
    mass_within,
    most_likely,
)
from planner.belief.grid import fold, prior_belief
from planner.types import Bearing, GaussianPrior, LinearMotion, Problem

SIGMA = np.deg2rad(4.0)
SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]])
PROBLEM = Problem(area=(SQUARE,), sigma=SIGMA, threshold=5.0, measurement_time=10.0, motion=LinearMotion(5.0))


def crossing(*angles):
    spots = [(150.0, 0.0), (0.0, 150.0), (300.0, 150.0)]
    return [Bearing(x, y, a, SIGMA) for (x, y), a in zip(spots, angles, strict=False)]


def test_one_wedge_on_a_flat_prior_is_told_by_its_mean_then_by_its_mode():
    one = fold(PROBLEM, crossing(np.pi / 2))
    mean = estimate(one, "expected_value")
    assert (estimate(one, "map").x, estimate(one, "map").y) == (mean.x, mean.y)
    two = fold(PROBLEM, crossing(np.pi / 2 + 0.02, 0.3))
    mode = estimate(two, "map")
    column = int((mode.x - two.x0) / two.h)
    row = int((mode.y - two.y0) / two.h)
    assert two.density[row, column] == two.density.max()


def test_a_gaussian_prior_is_told_by_its_mode_from_the_start():
    gaussian = Problem(
        area=(SQUARE,),
        sigma=SIGMA,
        threshold=5.0,
        measurement_time=10.0,
        motion=LinearMotion(5.0),
        prior=GaussianPrior(97.5, 151.5, np.diag([100.0, 1600.0])),
    )
    look = estimate(prior_belief(gaussian), "map")
    assert (look.x, look.y) == (97.5, 151.5)


def test_doubling_does_not_move_the_mode_to_a_corner_of_its_parent():
    belief = fold(PROBLEM, [Bearing(150.0, 100.0, np.pi / 2, SIGMA), Bearing(100.0, 151.5, 0.0, SIGMA)])
    assert belief.copies == 2
    look = estimate(belief, "map")
    corner = (look.x - belief.x0) / (2 * belief.h) % 1.0
    assert corner == pytest.approx(0.5)


@example([1.0, 1.0, 0.03125], 0)
@given(st.lists(st.floats(0.01, 1.0), min_size=3, max_size=30), st.integers(0, 1000))
def test_nothing_beats_the_geometric_median(weights, seed):
    rng = np.random.default_rng(seed)
    mass = np.array(weights) / sum(weights)
    x, y = rng.uniform(-50, 50, (2, len(mass)))
    px, py = geometric_median(mass, x, y, tolerance=1e-6)
    least = mass @ np.hypot(x - px, y - py)
    for qx, qy in [*zip(x, y, strict=True), *rng.uniform(-50, 50, (20, 2))]:
        assert least <= (1 + 1e-3) * (mass @ np.hypot(x - qx, y - qy)) + 1e-6


def plain_median(mass, x, y, tolerance):
    """Weiszfeld's iteration, array by array."""
    at = np.array([mass @ x, mass @ y])
    for _ in range(MEDIAN_STEPS):
        weight = mass / np.maximum(np.hypot(x - at[0], y - at[1]), tolerance)
        before, at = at, np.array([weight @ x, weight @ y]) / weight.sum()
        if np.hypot(*(at - before)) < tolerance:
            break
    tried = [at, *np.stack([x, y], axis=1)[np.argsort(-mass, kind="stable")[:HEAVY_POINTS]]]
    return min(tried, key=lambda one: mass @ np.hypot(x - one[0], y - one[1]))


@given(st.integers(2, 200), st.integers(0, 1000))
def test_the_compiled_median_is_the_plain_one(points, seed):
    rng = np.random.default_rng(seed)
    mass = rng.exponential(size=points) ** 2
    mass /= mass.sum()
    x, y = rng.uniform(-500, 500, (2, points))
    found = geometric_median(mass, x, y, tolerance=1e-9)
    assert found == pytest.approx(plain_median(mass, x, y, 1e-9), abs=1e-7)


@given(st.floats(1.3, 1.8), st.floats(-0.2, 0.4))
def test_the_median_has_the_least_expected_rmse_of_the_three(north, east):
    belief = fold(PROBLEM, crossing(north, east))
    median = estimate(belief, "geometric_median").expected_rmse
    assert median <= estimate(belief, "map").expected_rmse + 1e-6
    assert median <= estimate(belief, "expected_value").expected_rmse + 1e-6


def test_equal_cells_are_told_apart_by_order_not_by_rounding():
    mass = np.array([0.1, 0.3, 0.3 * (1 + 1e-14), 0.3 * (1 - 1e-14)])
    assert most_likely(mass) in (1, 2)
    assert most_likely(np.array([0.2, 0.4, 0.4, 0.0])) == 1


def test_entropy_and_rmse_of_a_uniform_square():
    look = estimate(prior_belief(PROBLEM), "expected_value")
    assert look.entropy == pytest.approx(np.log(100 * 100))
    assert look.expected_rmse == pytest.approx(300 * 0.3826, rel=1e-3)
    assert np.diag(look.covariance) == pytest.approx([300**2 / 12] * 2, rel=1e-3)


def test_the_region_of_an_even_belief_leaves_out_no_side_of_its_area():
    region = confidence_region(prior_belief(PROBLEM))
    assert region.min(axis=0).tolist() == [0.0, 0.0]
    assert region.max(axis=0).tolist() == [300.0, 300.0]


def test_confidence_regions_are_nested_and_mass_within_grows():
    belief = fold(PROBLEM, crossing(np.pi / 2, 0.1))
    small, large = confidence_region(belief, 0.5), confidence_region(belief, 0.95)
    extent = [np.ptp(hull, axis=0).prod() for hull in (small, large)]
    assert extent[0] < extent[1]
    look = estimate(belief, "map")
    assert mass_within(belief, look.x, look.y, 5.0) < mass_within(belief, look.x, look.y, 50.0) <= 1.0
