"""A joint belief counts what a source's bearings have in common once, and uses what it finds out about it."""

from dataclasses import replace

import numpy as np
import pytest

from planner.belief import compiled_evidence, evidence
from planner.belief.compiled_tables import RESCALED_EVERY
from planner.belief.estimate import confidence_region, estimate
from planner.belief.evidence import sightings
from planner.belief.grid import prior_belief
from planner.belief.joint import JointBelief, corrected, fold_joint, joint_prior, update_joint
from planner.belief.source_errors import ErrorPrior, nodes
from planner.belief.verdict import stated, verdict
from planner.geometry import distance_to_convex
from planner.observation import mixture_likelihood, wrap
from planner.types import Bearing, LinearMotion, LocalizationRule, Peak, PlannerError, Problem

SIGMA = np.deg2rad(4.0)
SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]])
PROBLEM = Problem(area=(SQUARE,), sigma=SIGMA, threshold=10.0, measurement_time=10.0, motion=LinearMotion(5.0))
TARGET = (160.0, 170.0)
AROUND = ((160.0, 60.0), (260.0, 170.0), (160.0, 280.0), (50.0, 170.0), (60.0, 60.0), (260.0, 270.0))
KNOWN = ErrorPrior(
    spread=np.array([1e-6]),
    spread_weight=np.ones(1),
    scale=np.ones(1),
    scale_weight=np.ones(1),
    rate=np.array([0.1]),
    rate_weight=np.ones(1),
)
"""A compass that is right and sigmas that are true: what the independent model takes for granted."""


def toward(place, error_deg=0.0, source="craft", **more):
    direction = np.arctan2(TARGET[1] - place[1], TARGET[0] - place[0])
    x, y = place
    return Bearing(x, y, float(wrap(direction + np.deg2rad(error_deg))), SIGMA, source=source, **more)


def joint(bearings, problem=PROBLEM, **known):
    belief = joint_prior(problem, **known)
    for bearing in bearings:
        belief = update_joint(belief, bearing)
    return belief


def profile(angle, sigma, further=()):
    """Log likelihood in 360 directions of a normal error, and of further peaks (angle, weight)."""
    directions = 2.0 * np.pi * np.arange(360) / 360
    peaks = [(angle, 1.0), *further]
    return tuple(
        np.logaddexp.reduce([np.log(w) - 0.5 * (wrap(directions - a) / sigma) ** 2 for a, w in peaks]).tolist()
    )


def random_bearings(rng, count):
    return [
        Bearing(
            rng.uniform(0.0, 300.0),
            rng.uniform(0.0, 300.0),
            rng.uniform(-np.pi, np.pi),
            rng.uniform(np.deg2rad(1.0), np.deg2rad(20.0)),
            peaks=tuple(Peak(rng.uniform(-np.pi, np.pi), rng.uniform(0.1, 1.0)) for _ in range(rng.integers(3))),
        )
        for _ in range(count)
    ]


@pytest.mark.parametrize("count", [1, 2, 5, RESCALED_EVERY, 19])
def test_the_compiled_evidence_is_that_of_the_readable_one(count):
    rng = np.random.default_rng(count)
    seen = sightings(random_bearings(rng, count))
    x, y = rng.uniform(0.0, 300.0, (2, 40))
    for prior in (ErrorPrior(), KNOWN, replace(KNOWN, rate=np.array([0.01]))):
        grid = nodes(prior, float(seen.sigma.min()), count)
        fast, plain = compiled_evidence.evidence(x, y, seen, grid), evidence.evidence(x, y, seen, grid)
        assert fast.log == pytest.approx(plain.log, abs=1e-4 * count)
        for ours, theirs in zip(fast[1:], plain[1:], strict=True):
            assert ours == pytest.approx(theirs, abs=1e-4 * count)
            assert ours.sum(axis=1) == pytest.approx(1.0)


@pytest.mark.parametrize("count", [1, 4])
def test_the_compiled_evidence_of_whole_sweeps_is_that_of_the_readable_one(count):
    rng = np.random.default_rng(count)
    bearings = [
        replace(b, profile=profile(b.angle, b.sigma, [(peak.angle, peak.weight) for peak in b.peaks])) if k % 3 else b
        for k, b in enumerate(random_bearings(rng, count + 1))
    ]
    seen = sightings(bearings)
    x, y = rng.uniform(0.0, 300.0, (2, 40))
    grid = nodes(ErrorPrior(), float(seen.sigma.min()), count)
    fast, plain = compiled_evidence.evidence(x, y, seen, grid), evidence.evidence(x, y, seen, grid)
    assert fast.log == pytest.approx(plain.log, abs=2e-3 * (count + 1))
    for ours, theirs in zip(fast[1:], plain[1:], strict=True):
        assert ours == pytest.approx(theirs, abs=2e-3 * (count + 1))


@pytest.mark.parametrize("count", [1, 2, 5, RESCALED_EVERY, 19])
@pytest.mark.parametrize("whole", [False, True])
def test_a_weigher_asked_in_parts_says_what_the_evidence_does(count, whole):
    rng = np.random.default_rng(count)
    bearings = [*random_bearings(rng, count), replace(random_bearings(rng, 1)[0], sigma=np.deg2rad(4.0))]
    bearings += [replace(b, angle=float(b.angle + 0.1)) for b in bearings[-1:]]  # of one sigma, so of one table
    if whole:
        bearings[0] = replace(bearings[0], profile=profile(bearings[0].angle, bearings[0].sigma))
    seen = sightings(bearings)
    x, y = rng.uniform(-900.0, 900.0, (2, 60))
    mass = rng.dirichlet(np.ones(60))
    for prior in (ErrorPrior(), KNOWN, replace(KNOWN, rate=np.array([0.01]))):
        grid = nodes(prior, float(seen.sigma.min()), count)
        found, asked = compiled_evidence.evidence(x, y, seen, grid), compiled_evidence.Weigher(seen, grid)
        in_parts = np.concatenate([asked.log(x[:7], y[:7]), asked.log(x[7:], y[7:])])
        assert in_parts == pytest.approx(found.log, rel=1e-12, abs=1e-10)
        shared, plain = asked.shared_out(x, y, mass), evidence.Weigher(seen, grid).shared_out(x, y, mass)
        for ours, theirs in zip(shared, (mass @ found.bias, mass @ found.scale, mass @ found.rate), strict=False):
            assert ours == pytest.approx(theirs, abs=1e-12)
        assert shared.mean == pytest.approx(found.bias @ grid.bias, abs=1e-12)
        for ours, theirs in zip(shared, plain, strict=True):
            assert ours == pytest.approx(theirs, abs=2e-3 * len(bearings))


def test_places_that_no_bearing_points_at_have_the_outliers_share_alone():
    """All nodes out of reach: nothing is left but the prior, times what outliers have in common."""
    seen = sightings([Bearing(0.0, 0.0, 0.0, np.deg2rad(2.0)), Bearing(10.0, 0.0, 0.1, np.deg2rad(2.0))])
    grid = nodes(ErrorPrior(), float(seen.sigma.min()), 2)
    asked, plain = compiled_evidence.Weigher(seen, grid), evidence.Weigher(seen, grid)
    behind, beside = np.array([-500.0, -500.0]), np.array([0.0, 30.0])
    assert asked.log(behind, beside) == pytest.approx(plain.log(behind, beside), abs=1e-9)
    ours, theirs = (way.shared_out(behind, beside, np.array([0.5, 0.5])) for way in (asked, plain))
    for one, other in zip(ours, theirs, strict=True):
        assert one == pytest.approx(other, abs=1e-12)


def test_the_belief_by_the_readable_evidence_is_nearly_the_same():
    bearings = [toward(place, error) for place, error in zip(AROUND[:3], (5.0, 8.0, 3.0), strict=True)]
    ours, theirs = joint(bearings[:-1]), joint(bearings[:-1])
    ours, theirs = (
        update_joint(one, bearings[-1], way.Weigher) for one, way in ((ours, compiled_evidence), (theirs, evidence))
    )
    assert 0.5 * np.abs(ours.density - theirs.density).sum() < 1e-3
    assert ours.errors[0].bias == pytest.approx(theirs.errors[0].bias, abs=1e-4)


def test_a_whole_sweep_that_says_no_more_than_its_bearing_makes_the_same_belief():
    bearings = [toward(place, error) for place, error in zip(AROUND[:4], (5.0, 8.0, 3.0, 6.0), strict=True)]
    whole = [replace(b, profile=profile(b.angle, b.sigma)) for b in bearings]
    found, expected = (estimate(joint(some), "geometric_median") for some in (whole, bearings))
    assert (found.x, found.y) == pytest.approx((expected.x, expected.y), abs=0.5)
    assert found.expected_rmse == pytest.approx(expected.expected_rmse, rel=0.05)


def test_a_second_peak_and_a_flat_sweep_count_for_what_they_tell():
    true, echo = toward(AROUND[0]).angle, toward(AROUND[0], 90.0).angle
    wrong = replace(toward(AROUND[0]), angle=echo, profile=profile(echo, SIGMA, [(true, 0.9)]))
    others = [toward(AROUND[1], 1.0), toward(AROUND[2], -1.0)]
    found = estimate(joint([wrong, *others]), "geometric_median")
    assert np.hypot(found.x - TARGET[0], found.y - TARGET[1]) < 8.0
    flat = replace(toward(AROUND[3], 60.0), profile=(0.0,) * 360)
    without, with_it = (estimate(joint(some), "geometric_median") for some in (others, [*others, flat]))
    assert with_it.expected_rmse == pytest.approx(without.expected_rmse, rel=0.02)


@pytest.mark.parametrize("bad", [(0.0,) * 5, (*(0.0,) * 359, np.nan)])
def test_a_profile_of_no_use_is_refused(bad):
    with pytest.raises(PlannerError, match="eight directions"):
        joint([toward(AROUND[0], profile=bad)])


def test_evidence_is_the_integral_over_the_bias():
    """With one scale and one rate: p(z | x) = integral p(b) prod_i p(z_i | x, b) db, by brute force on a fine grid."""
    prior = ErrorPrior(scale=np.ones(1), scale_weight=np.ones(1), rate=np.array([0.1]), rate_weight=np.ones(1))
    bearings = [toward(AROUND[0], 5.0), toward(AROUND[1], 7.0), toward(AROUND[2], -30.0)]
    x, y = np.array([160.0, 150.0, 190.0]), np.array([170.0, 185.0, 140.0])
    bias = np.deg2rad(np.linspace(-27.0, 27.0, 20_001))
    density = (np.exp(-0.5 * (bias[:, None] / prior.spread) ** 2) / prior.spread) @ prior.spread_weight
    density /= density.sum()
    expected = np.zeros(3)
    for c in range(3):
        turned = np.ones(len(bias))
        for b in bearings:
            off = wrap(b.angle - np.arctan2(y[c] - b.y, x[c] - b.x) - bias)
            turned *= 0.9 * np.exp(-0.5 * (off / SIGMA) ** 2) + 0.1 * SIGMA / np.sqrt(2 * np.pi)
        expected[c] = np.log(density @ turned)
    found = evidence.evidence(x, y, sightings(bearings), nodes(prior, float(SIGMA), 3)).log
    assert found == pytest.approx(expected, abs=0.02)


def test_with_nothing_unknown_it_is_the_independent_belief():
    bearings = [toward(AROUND[0], 3.0), toward(AROUND[1], -2.0)]
    belief = joint(bearings, otherwise=KNOWN)
    x, y = np.meshgrid(*belief.centres())
    density = belief.prior.copy()
    for b in bearings:
        density *= mixture_likelihood(replace(b, outlier_probability=0.1), x, y)
    assert belief.density == pytest.approx(density / density.sum(), abs=1e-6 * belief.density.max() * 100)


def test_a_common_bias_is_found_and_used():
    bearings = [
        toward(place, 9.0 + error) for place, error in zip(AROUND, (1.5, -2.0, 1.0, -1.0, 0.5, 0.0), strict=True)
    ]
    belief = joint(bearings)
    (errors,) = belief.errors
    assert errors.bearings == len(AROUND)
    assert abs(np.rad2deg(errors.bias) - 9.0) < 2.0 * np.rad2deg(errors.bias_sd) < 6.0
    found = estimate(belief, "geometric_median")
    assert np.hypot(found.x - TARGET[0], found.y - TARGET[1]) < 5.0
    freed = corrected(belief, bearings)
    assert abs(freed[0].angle - toward(AROUND[0]).angle) < np.deg2rad(4.0)
    assert freed[0].sigma > errors.bias_sd


def test_bearings_from_one_side_leave_the_bias_open_and_their_error_in_the_place():
    """The independent belief thinks that a third bearing from the same side helps as much as the first."""
    south = [(130.0, 40.0), (160.0, 30.0), (190.0, 40.0)]
    bearings = [replace(toward(place, 8.0), sigma=np.deg2rad(1.5)) for place in south]
    belief, alone = joint(bearings), joint(bearings, otherwise=KNOWN)
    there = np.array([TARGET])
    assert (
        distance_to_convex(there, confidence_region(belief))[0]
        <= 0.0
        < distance_to_convex(there, confidence_region(alone))[0]
    )
    assert belief.errors[0].bias_sd > np.deg2rad(3.0)


def test_each_source_has_errors_of_its_own():
    bearings = [toward(p, 8.0, "craft") for p in AROUND[:4]] + [toward(p, -8.0, "person:Ada") for p in AROUND[:4]]
    belief = joint(bearings)
    craft, person = belief.errors_of("craft"), belief.errors_of("person:Ada")
    assert craft is not None
    assert person is not None
    assert belief.errors_of("nobody") is None
    assert craft.bias > np.deg2rad(4.0)
    assert person.bias < -np.deg2rad(4.0)
    assert estimate(belief, "map").expected_rmse < 10.0


def test_sigmas_that_were_stated_too_small_are_found_to_be():
    far = (9.0, -8.0, 10.0, -9.0, 7.0, -10.0)
    belief = joint([toward(place, error) for place, error in zip(AROUND, far, strict=True)])
    exact = joint([toward(place) for place in AROUND])
    assert belief.errors[0].scale > 1.15 > 0.95 > exact.errors[0].scale
    assert estimate(belief, "map").expected_rmse > 1.5 * estimate(exact, "map").expected_rmse


def test_an_outlier_raises_the_rate_and_spoils_nothing():
    good = [toward(place, 2.0) for place in AROUND]
    belief = joint([*good[:3], toward((100.0, 100.0), 120.0), *good[3:]])
    assert belief.errors[0].outlier_rate > joint(good).errors[0].outlier_rate
    found = estimate(belief, "map")
    assert np.hypot(found.x - TARGET[0], found.y - TARGET[1]) < 12.0


def test_the_order_of_the_bearings_does_not_matter():
    bearings = [toward(place, error) for place, error in zip(AROUND, (4.0, 7.0, 3.0, 5.0, 50.0, 6.0), strict=True)]
    one, other = joint(bearings), joint(bearings[::-1])
    mine, theirs = (estimate(b, "expected_value") for b in (one, other))
    assert (mine.x, mine.y) == pytest.approx((theirs.x, theirs.y), abs=0.2)
    assert one.errors[0].bias == pytest.approx(other.errors[0].bias, abs=np.deg2rad(0.1))


def test_what_is_known_of_a_compass_counts():
    right = replace(ErrorPrior(), spread_weight=np.array([1.0, 0, 0, 0, 0, 0]))
    bearings = [toward(AROUND[0]), toward(AROUND[1]), toward(AROUND[4])]
    known, unknown = joint(bearings, priors={"craft": right}), joint(bearings)
    assert estimate(known, "map").expected_rmse < 0.9 * estimate(unknown, "map").expected_rmse
    assert joint(bearings, priors={"person": right}).errors[0].bias_sd == unknown.errors[0].bias_sd


def test_bearings_that_all_contradict_each_other_leave_a_belief_and_no_claim():
    bearings = [toward(place, 70.0 * number) for number, place in enumerate(AROUND[:4])]
    belief = joint(bearings)
    assert belief.density.sum() == pytest.approx(1.0)
    assert not verdict(PROBLEM, LocalizationRule(threshold=10.0), bearings, belief).localized


def test_a_biased_flight_is_claimed_with_bearings_that_are_judged_without_their_bias():
    bearings = [replace(toward(place, 16.0), sigma=np.deg2rad(2.0)) for place in (*AROUND, *AROUND)]
    said = verdict(PROBLEM, LocalizationRule(threshold=10.0), bearings, joint(bearings))
    assert said.localized
    assert said.consistent
    assert said.against == ()


def test_the_grid_becomes_fine_where_the_emitter_is_and_stays_a_grid_belief():
    wide = replace(PROBLEM, area=(10.0 * SQUARE,))
    bearings = [toward(place, 0.5) for place in AROUND]
    belief = joint(bearings, problem=wide)
    assert isinstance(belief, JointBelief)
    assert belief.h < prior_belief(wide).h / 2.0
    assert belief.prior.shape == belief.density.shape
    assert belief.bearings == len(bearings)


def test_a_bearing_without_numbers_is_refused():
    with pytest.raises(PlannerError):
        update_joint(joint_prior(PROBLEM), Bearing(0.0, 0.0, float("nan"), SIGMA))


@pytest.mark.parametrize("size", [1.0, 10.0])
def test_bearings_folded_at_once_say_what_they_say_one_by_one(size):
    """On cells that may be cropped and cut otherwise."""
    wide = replace(PROBLEM, area=(size * SQUARE,))
    rng = np.random.default_rng(3)
    bearings = [toward(place, 2.0 + rng.normal(0.0, 3.0)) for place in (*AROUND, *(1.7 * np.array(AROUND)))]
    one_by_one = joint(bearings, problem=wide)
    at_once = fold_joint(joint_prior(wide), bearings)
    assert (at_once.folded, at_once.bearings) == (tuple(bearings), len(bearings))
    said = [stated(one, estimate(one, wide.estimator), 10.0) for one in (one_by_one, at_once)]
    assert said[1].expected_rmse == pytest.approx(said[0].expected_rmse, rel=0.02)
    assert np.hypot(said[1].x - said[0].x, said[1].y - said[0].y) < 0.1 * said[0].expected_rmse
    assert at_once.errors[0].bias == pytest.approx(one_by_one.errors[0].bias, abs=0.1 * one_by_one.errors[0].bias_sd)


def test_a_bearing_without_numbers_among_others_is_refused():
    with pytest.raises(PlannerError):
        fold_joint(joint_prior(PROBLEM), [toward(AROUND[0]), Bearing(0.0, 0.0, float("nan"), SIGMA)])
