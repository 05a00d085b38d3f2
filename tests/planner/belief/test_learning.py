"""Flights without truth narrow what is assumed of a source, and never to nothing."""

from functools import cache

import numpy as np
import pytest

from planner.belief.joint import joint_prior, update_joint
from planner.belief.learning import SURPRISE, evidence_at, flight_evidence, learned
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
    return flight_evidence(belief, "")


@cache
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
    prior = after(12, 0.5)
    assert (prior.spread_weight >= 0.99 * SURPRISE * UNKNOWN.spread_weight).all()
    for weights in (prior.spread_weight, prior.scale_weight, prior.rate_weight):
        assert weights.sum() == pytest.approx(1.0)


def test_evidence_does_not_depend_on_what_was_assumed():
    """A flight teaches the same whoever believed what before it."""
    skewed = ErrorPrior(
        spread_weight=np.array([0.3, 0.3, 0.2, 0.1, 0.05, 0.05]),
        scale_weight=np.array([0.8, 0.1, 0.1]),
        rate_weight=np.array([0.2, 0.8]),
    )
    one, other = (flight(np.random.default_rng(3), 4.0, prior=prior) for prior in (UNKNOWN, skewed))
    assert one == pytest.approx(other, abs=0.02)


def test_evidence_is_that_of_the_numpy_sums():
    """Of three bearings of an emitter at a known place, by quadrature over the bias."""
    target, wrong = (150.0, 160.0), np.deg2rad([4.0, 6.5, 20.0])
    bearings = [
        Bearing(x, y, float(np.arctan2(target[1] - y, target[0] - x) + off), SIGMA)
        for (x, y), off in zip(PLACES, wrong, strict=False)
    ]
    expected = np.empty((len(UNKNOWN.spread), len(UNKNOWN.scale), len(UNKNOWN.rate)))
    b = np.deg2rad(np.arange(-27.0, 27.0, 0.01))
    for t, tau in enumerate(UNKNOWN.spread):
        for k, s in enumerate(UNKNOWN.scale * SIGMA):
            for e, rate in enumerate(UNKNOWN.rate):
                each = (1.0 - rate) * np.exp(-0.5 * ((wrong[:, None] - b) / s) ** 2) / (s * np.sqrt(2.0 * np.pi))
                mass = np.exp(-0.5 * (b / tau) ** 2) / (tau * np.sqrt(2.0 * np.pi)) * np.deg2rad(0.01)
                expected[t, k, e] = np.log(mass @ np.prod(each + rate / (2.0 * np.pi), axis=0))
    off = evidence_at(bearings, UNKNOWN, target) - (expected - expected.max())
    assert np.abs(off[2:]).max() < 0.05
    assert np.abs(off[:2]).max() < 0.25  # a spread under the nodes' spacing counts as a little wider


def test_a_known_place_tells_an_outlier_that_the_bearings_alone_do_not():
    target = (150.0, 160.0)
    off = np.deg2rad([0.0, 40.0])  # they cross in the area all the same
    bearings = [
        Bearing(x, y, float(np.arctan2(target[1] - y, target[0] - x) + turned), SIGMA)
        for (x, y), turned in zip(PLACES, off, strict=False)
    ]
    belief = joint_prior(PROBLEM)
    for one in bearings:
        belief = update_joint(belief, one)
    told, found = (learned([e], UNKNOWN) for e in (evidence_at(bearings, UNKNOWN, target), flight_evidence(belief, "")))
    assert told.rate_weight[1] > found.rate_weight[1] + 0.1
