"""Flights without truth narrow what is assumed of a source, and never to nothing."""

import numpy as np
import pytest

from planner.belief.joint import joint_prior, update_joint
from planner.belief.learning import SURPRISE, flight_evidence, learned
from planner.belief.source_errors import ErrorPrior
from planner.types import Bearing, LinearMotion, Problem

SIGMA = np.deg2rad(3.0)
SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]])
PROBLEM = Problem(area=(SQUARE,), sigma=SIGMA, threshold=10.0, measurement_time=10.0, motion=LinearMotion(5.0))
PLACES = ((40.0, 40.0), (260.0, 50.0), (250.0, 260.0), (60.0, 240.0), (150.0, 20.0))
UNKNOWN = ErrorPrior()


def flight(rng, bias_sd_deg, own=SIGMA, outliers=0.0, prior=UNKNOWN):
    """The evidence of one flight around an emitter that is never named."""
    target, bias = rng.uniform(110.0, 190.0, 2), np.deg2rad(bias_sd_deg) * rng.standard_normal()
    belief = joint_prior(PROBLEM, otherwise=prior)
    for x, y in PLACES:
        angle = np.arctan2(target[1] - y, target[0] - x) + bias + own * rng.standard_normal()
        if rng.uniform() < outliers:
            angle = rng.uniform(-np.pi, np.pi)
        belief = update_joint(belief, Bearing(x, y, float(angle), SIGMA))
    return flight_evidence(belief.errors[0])


def after(count, bias_sd_deg, **more):
    rng = np.random.default_rng(5)
    return learned([flight(rng, bias_sd_deg, **more) for _ in range(count)], UNKNOWN)


def test_nothing_is_learned_from_no_flight():
    prior = learned([], UNKNOWN)
    assert prior.spread_weight == pytest.approx(UNKNOWN.spread_weight)
    assert prior.bias_sd == pytest.approx(UNKNOWN.bias_sd)


def test_flights_tell_a_right_compass_from_a_wrong_one_without_any_truth():
    right, wrong = after(12, 0.5), after(12, 9.0)
    assert np.rad2deg(right.bias_sd) < 3.0
    assert np.rad2deg(wrong.bias_sd) > 5.5
    assert right.spread_weight[:3].sum() > 0.8
    assert wrong.spread_weight[-2:].sum() > 0.8


def test_one_flight_says_little():
    assert np.abs(after(1, 0.5).spread_weight - UNKNOWN.spread_weight).max() < 0.3


def test_sigmas_that_are_stated_wrong_are_learned():
    assert after(8, 2.0, own=0.3 * SIGMA).scale_weight[0] > 0.7
    assert after(8, 2.0, own=1.8 * SIGMA).scale_weight[2] > 0.7


def test_outliers_are_learned():
    assert after(8, 2.0, outliers=0.3).rate_weight[1] > after(8, 2.0).rate_weight[1] + 0.2


def test_nothing_is_ever_excluded():
    prior = after(20, 0.5)
    assert (prior.spread_weight >= 0.99 * SURPRISE * UNKNOWN.spread_weight).all()
    for weights in (prior.spread_weight, prior.scale_weight, prior.rate_weight):
        assert weights.sum() == pytest.approx(1.0)


def test_evidence_does_not_depend_on_what_was_assumed():
    """The posterior over the prior is the likelihood: a flight teaches the same whoever believed what before it.

    Not exactly: what was assumed of scale and rate weighs the bias' evidence.
    """
    skewed = ErrorPrior(spread_weight=np.array([0.3, 0.3, 0.2, 0.1, 0.05, 0.05]))
    one, other = (flight(np.random.default_rng(3), 4.0, prior=prior).spread for prior in (UNKNOWN, skewed))
    assert one - one.max() == pytest.approx(other - other.max(), abs=0.05)
