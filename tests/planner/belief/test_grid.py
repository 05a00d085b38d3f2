"""The adaptive grid filter: laws of probability, geometry of cropping, inconsistency, mixtures."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refusing

from planner.belief import grid
from planner.belief.estimate import confidence_region, estimate
from planner.belief.grid import COARSE_CELLS, FINER, FIRST_CELLS, MOST_CELLS, digest, fold, prior_belief, update
from planner.geometry import contains
from planner.reasons import (
    BearingMissesArea,
    BearingsDisagree,
    PriorOutsideArea,
    UnusableBearing,
    UnusableGaussian,
    UnusableRing,
)
from planner.types import (
    Bearing,
    GaussianPrior,
    InconsistentBearings,
    LinearMotion,
    Peak,
    PlannerError,
    Problem,
    RingPrior,
    UniformPrior,
)

SIGMA = np.deg2rad(4.0)


def rectangle(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


def problem(**changes):
    plain = Problem(
        area=(rectangle(0, 0, 300, 300),), sigma=SIGMA, threshold=5.0, measurement_time=10.0, motion=LinearMotion(5.0)
    )
    return replace(plain, **changes)


def toward(x, y, target, error=0.0, sigma=SIGMA, **more):
    return Bearing(x, y, float(np.arctan2(target[1] - y, target[0] - x)) + error, sigma, **more)


places = st.tuples(st.floats(-200, 500), st.floats(-200, 500))
targets = st.tuples(st.floats(5, 295), st.floats(5, 295))
errors = st.floats(-3, 3).map(lambda n: n * SIGMA)


@given(targets, st.lists(st.tuples(places, errors), min_size=1, max_size=5))
def test_honest_bearings_keep_mass_one_and_the_target_possible(target, looks):
    belief = prior_belief(problem())
    for (x, y), error in looks:
        belief = update(belief, toward(x, y, target, error))
        assert belief.density.sum() == pytest.approx(1.0)
        assert (belief.density >= 0).all()
    x0, y0, x1, y1 = belief.bounds
    assert x0 <= target[0] <= x1
    assert y0 <= target[1] <= y1
    column, row = int((target[0] - x0) / belief.h), int((target[1] - y0) / belief.h)
    assert belief.density[min(row, belief.ny - 1), min(column, belief.nx - 1)] > 0


@given(targets, st.lists(st.tuples(places, st.floats(-np.pi, np.pi)), min_size=1, max_size=5))
def test_a_mixture_never_loses_its_mass_whatever_is_heard(target, looks):
    belief = prior_belief(problem())
    for (x, y), error in looks:
        belief = update(belief, toward(x, y, target, error, outlier_probability=0.05))
        assert belief.density.sum() == pytest.approx(1.0)
        assert belief.density.size <= MOST_CELLS


def test_first_grid_has_a_hundred_square_cells_on_the_longer_axis():
    belief = prior_belief(problem(area=(rectangle(-10, 5, 303, 125),)))
    assert (belief.nx, belief.ny) == (FIRST_CELLS, 39)
    assert belief.h == pytest.approx(3.13)
    assert (belief.x0, belief.y0) == (-10.0, 5.0)


NEAR = ((150, 110), (125, 150), (155, 135))


def resolved(bearings=NEAR, target=(150, 150)):
    belief = prior_belief(problem(likelihood="resolved"))
    for k, (x, y) in enumerate(bearings):
        belief = update(belief, toward(x, y, target, error=(0.5 - k) * SIGMA), "resolved")
    return belief


def test_resolved_likelihoods_have_finer_cells_from_the_first_to_the_last():
    assert resolved(bearings=()).nx == FINER * FIRST_CELLS
    for count in (1, 2, 3):
        belief = resolved(NEAR[:count])
        assert max(belief.nx, belief.ny) >= FINER * COARSE_CELLS
        assert belief.copies == 1


@pytest.mark.parametrize("count", [2, 3])
def test_what_resolved_cells_state_is_what_four_times_finer_ones_do(monkeypatch, count):
    stated = estimate(resolved(NEAR[:count]), "geometric_median").expected_rmse
    monkeypatch.setattr(grid, "FINER", 4 * FINER)
    assert stated == pytest.approx(estimate(resolved(NEAR[:count]), "geometric_median").expected_rmse, rel=0.03)


def test_cells_outside_a_non_convex_area_hold_nothing():
    corner = np.array([[0, 0], [300, 0], [300, 100], [100, 100], [100, 300], [0, 300]], dtype=float)
    belief = prior_belief(problem(area=(corner,)))
    assert belief.density[60, 60] == 0.0
    assert belief.density[10, 90] == belief.density[90, 10] > 0.0


def test_a_wedge_over_a_notch_crops_to_the_hull_of_both_parts():
    corner = np.array([[0, 0], [300, 0], [300, 300], [200, 300], [200, 100], [100, 100], [100, 300], [0, 300]], float)
    belief = update(prior_belief(problem(area=(corner,))), Bearing(-50.0, 200.0, 0.0, SIGMA))
    x0, _, x1, _ = belief.bounds
    assert (x0, x1) == (0.0, 300.0)
    _, columns = np.nonzero(belief.density)
    x = belief.x0 + (columns + 0.5) * belief.h
    assert not ((x > 103) & (x < 197)).any()


def test_cropping_keeps_the_cells_of_the_first_grid_and_doubling_halves_them():
    belief = update(prior_belief(problem()), toward(150, -300, (150, 150)))
    assert belief.h == 3.0
    assert (belief.x0 / 3.0) == pytest.approx(round(belief.x0 / 3.0))
    near = update(update(prior_belief(problem()), toward(150, 100, (150, 150))), toward(100, 150, (150, 150)))
    assert near.h == 1.5
    assert (near.density[::2, ::2] == near.density[1::2, 1::2]).all()
    assert near.copies == 2


def test_a_small_wedge_is_never_weighed_on_a_handful_of_cells():
    wide = problem(area=(rectangle(0, 0, 3000, 3000),))
    belief = fold(wide, [toward(1000, 1490, (1010, 1500)), toward(1020, 1490, (1010, 1500))])
    assert belief.h < 2.0
    assert estimate(belief, "map").expected_rmse > 0.2


def test_wedges_without_a_common_point_raise_and_count_the_bearings():
    belief = update(prior_belief(problem()), Bearing(150.0, -10.0, np.pi / 2, SIGMA))
    with refusing(BearingsDisagree(2), InconsistentBearings):
        update(belief, Bearing(-10.0, 150.0, np.pi, SIGMA))


def test_a_first_bearing_past_the_area_says_so():
    with refusing(BearingMissesArea(), InconsistentBearings):
        update(prior_belief(problem()), Bearing(-10.0, 150.0, np.pi, SIGMA))


def test_the_same_contradiction_in_a_mixture_leaves_both_hypotheses():
    apart = [Bearing(150.0, -10.0, np.pi / 2, SIGMA), Bearing(295.0, 150.0, np.pi / 2, SIGMA)]
    with pytest.raises(InconsistentBearings):
        fold(problem(), apart)
    belief = fold(problem(), [replace(bearing, outlier_probability=0.05) for bearing in apart])
    x = belief.x0 + (np.arange(belief.nx) + 0.5) * belief.h
    assert belief.density[:, x < 240].sum() > 0.1
    assert belief.density[:, x > 250].sum() > 0.1


def test_a_bearing_of_nearly_zero_width_leaves_its_line_of_sight():
    belief = update(prior_belief(problem()), Bearing(-50.0, 151.0, 0.0, 1e-7))
    rows, _ = np.nonzero(belief.density)
    y = belief.y0 + (rows + 0.5) * belief.h
    assert np.abs(y - 151.0).max() <= belief.h


@pytest.mark.parametrize("target", [(0.0, 0.0), (300.0, 300.0), (150.0, 300.0)])
def test_a_target_on_the_border_stays_possible(target):
    belief = fold(problem(), [toward(150, 20, target), toward(20, 150, target), toward(280, 150, target)])
    look = estimate(belief, "map")
    assert np.hypot(look.x - target[0], look.y - target[1]) < 25.0


@pytest.mark.parametrize("place", [(150.0, 150.0), (151.5, 151.5), (148.37, 160.2)])
def test_a_sensor_inside_the_belief_measures_too(place):
    belief = update(prior_belief(problem()), toward(place[0], place[1], (200.0, 150.0)))
    assert belief.density.sum() == pytest.approx(1.0)
    assert belief.bounds[0] >= place[0] - 2 * belief.h - 3.0


def test_several_peaks_of_one_sweep_enter_as_a_mixture():
    two = Bearing(150.0, 150.0, 0.0, SIGMA, peaks=(Peak(np.pi, 0.5),))
    belief = update(prior_belief(problem()), two)
    x = belief.x0 + (np.arange(belief.nx) + 0.5) * belief.h
    east = belief.density[:, x > 150].sum()
    assert east == pytest.approx(2 / 3, abs=0.02)


def test_a_gaussian_prior_is_cut_to_the_area():
    belief = prior_belief(problem(prior=GaussianPrior(150.0, 150.0, np.diag([100.0, 1600.0]))))
    look = estimate(belief, "expected_value")
    assert (look.x, look.y) == pytest.approx((150.0, 150.0))
    assert np.sqrt(np.diag(look.covariance)) == pytest.approx([10.0, 40.0], rel=0.02)
    assert not belief.flat_prior


def test_a_ring_prior_is_uniform_in_area_between_its_radii():
    ring = RingPrior(150.0, 150.0, 30.0, 120.0)
    belief = prior_belief(problem(prior=ring))
    x, y = np.meshgrid(*belief.centres())
    r = np.hypot(x - 150, y - 150)
    assert belief.density[(r < 25) | (r > 125)].sum() == 0.0
    inner = belief.density[r < 75].sum()
    assert inner == pytest.approx((75**2 - 30**2) / (120**2 - 30**2), rel=0.03)
    assert belief.bounds[0] == pytest.approx(30.0, abs=0.5)


def test_folding_twice_gives_the_same_bits_and_another_order_is_told_apart():
    looks = [toward(150, 0, (160, 170), 0.02), toward(30, 150, (160, 170), -0.03)]
    assert digest(fold(problem(), looks)) == digest(fold(problem(), looks))
    assert digest(fold(problem(), looks)) != digest(fold(problem(), looks[:1]))


@given(st.floats(-1e5, 1e5), st.floats(-1e5, 1e5), st.integers(0, 3))
def test_expected_rmse_does_not_depend_on_where_the_scene_lies(dx, dy, quarter):
    def moved(x, y):
        c, s = [(1, 0), (0, 1), (-1, 0), (0, -1)][quarter]
        return c * (x - 150) - s * (y - 150) + dx, s * (x - 150) + c * (y - 150) + dy

    target = (170.0, 190.0)
    looks = [((150.0, 20.0), 0.03), ((40.0, 160.0), -0.05)]
    area = rectangle(0, 0, 300, 300)
    turned = np.array([moved(*corner) for corner in area])
    here = fold(problem(), [toward(*place, target, e) for place, e in looks])
    there = fold(problem(area=(turned,)), [toward(*moved(*place), moved(*target), e) for place, e in looks])
    assert estimate(there, "expected_value").expected_rmse == pytest.approx(
        estimate(here, "expected_value").expected_rmse, rel=1e-3
    )


@given(targets, st.lists(st.tuples(places, errors), min_size=2, max_size=4))
def test_the_confidence_region_holds_its_share(target, looks):
    belief = fold(problem(), [toward(x, y, target, e) for (x, y), e in looks])
    hull = confidence_region(belief, 0.95)
    x, y = np.meshgrid(*belief.centres())
    inside = contains((hull,), np.column_stack([x.ravel(), y.ravel()])).reshape(x.shape)
    assert belief.density[inside].sum() >= 0.95 - 1e-9


@pytest.mark.parametrize(
    ("bearing", "flaw"),
    [
        (Bearing(np.nan, 0.0, 0.0, SIGMA), "not_finite"),
        (Bearing(0.0, 0.0, np.inf, SIGMA), "not_finite"),
        (Bearing(0.0, 0.0, 0.0, 0.0), "sigma"),
        (Bearing(0.0, 0.0, 0.0, SIGMA, outlier_probability=1.5), "outlier_probability"),
        (Bearing(0.0, 0.0, 0.0, SIGMA, peaks=(Peak(0.0, -1.0),)), "peak"),
    ],
)
def test_unusable_bearings_are_refused(bearing, flaw):
    with refusing(UnusableBearing(flaw), PlannerError):
        update(prior_belief(problem()), bearing)


@pytest.mark.parametrize(
    ("prior", "reason"),
    [
        (GaussianPrior(150.0, 150.0, np.zeros((2, 2))), UnusableGaussian()),
        (GaussianPrior(9000.0, 9000.0, np.eye(2)), PriorOutsideArea()),
        (RingPrior(150.0, 150.0, 50.0, 20.0), UnusableRing()),
        (RingPrior(9000.0, 9000.0, 1.0, 20.0), PriorOutsideArea()),
    ],
)
def test_unusable_priors_are_refused(prior, reason):
    with refusing(reason):
        prior_belief(problem(prior=prior))


def test_a_uniform_prior_is_flat():
    belief = prior_belief(problem(prior=UniformPrior()))
    assert np.ptp(belief.density) == pytest.approx(0.0, abs=1e-15)


@given(st.integers(0, 10_000), st.sampled_from([0.5, 0.95, 1.0 - 1e-6]), st.booleans())
def test_the_smallest_set_is_what_sorting_the_cells_themselves_finds(seed, share, ties):
    rng = np.random.default_rng(seed)
    mass = rng.exponential(size=tuple(rng.integers(1, 30, 2))) ** 3
    mass = np.round(mass, 1) + 0.1 if ties else mass
    belief = replace(prior_belief(problem()), density=mass / mass.sum())
    order = np.argsort(-belief.density.ravel(), kind="stable")
    within = np.cumsum(belief.density.ravel()[order])
    count = int(np.searchsorted(within, share * within[-1])) + 1
    assert np.array_equal(np.flatnonzero(grid.smallest_set(belief, share)), np.sort(order[:count]))
