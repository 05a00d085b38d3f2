"""Hypotheses: what a mixture belief holds apart, and which bearings speak for which."""

from dataclasses import replace

import numpy as np
import pytest

from planner.belief.grid import fold, prior_belief
from planner.belief.hypotheses import hypotheses
from planner.types import Bearing, LinearMotion, Peak, Problem

SIGMA = np.deg2rad(4.0)
SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]])
PROBLEM = Problem(area=(SQUARE,), sigma=SIGMA, threshold=5.0, measurement_time=10.0, motion=LinearMotion(5.0))
NORTH = Bearing(60.0, 0.0, np.pi / 2, SIGMA, outlier_probability=0.1)
EAST = Bearing(0.0, 60.0, 0.0, SIGMA, outlier_probability=0.1)


def test_bearings_that_agree_leave_one_hypothesis_that_all_support():
    found = hypotheses(fold(PROBLEM, [NORTH, EAST]), [NORTH, EAST])
    assert found[0].supporting == (0, 1)
    assert found[0].mass > 0.8
    assert np.hypot(found[0].x - 60, found[0].y - 60) < 6.0


def test_contradicting_bearings_leave_a_hypothesis_each():
    apart = replace(NORTH, x=280.0, y=150.0)
    bearings = [replace(NORTH, x=20.0), apart]
    found = hypotheses(fold(PROBLEM, bearings), bearings)
    assert {one.supporting for one in found[:2]} == {(0,), (1,)}
    assert sum(one.mass for one in found) <= 1.0
    assert [one.mass for one in found] == sorted((one.mass for one in found), reverse=True)


def test_a_third_bearing_tells_two_peaks_apart():
    two_peaks = Bearing(150.0, 150.0, 0.0, SIGMA, peaks=(Peak(np.pi, 0.9),))
    before = hypotheses(fold(PROBLEM, [two_peaks]), [two_peaks])
    assert len(before) == 2
    decider = Bearing(60.0, 30.0, np.pi / 2, SIGMA)
    after = hypotheses(fold(PROBLEM, [two_peaks, decider]), [two_peaks, decider])
    assert len(after) == 1
    assert after[0].x == pytest.approx(60.0, abs=6.0)


def test_a_flat_prior_is_one_hypothesis():
    assert len(hypotheses(prior_belief(PROBLEM), share=1.0)) == 1


def test_small_parts_are_left_out():
    two_peaks = Bearing(150.0, 150.0, 0.0, SIGMA, peaks=(Peak(np.pi, 0.2),))
    belief = fold(PROBLEM, [two_peaks])
    assert len(hypotheses(belief, share=0.99)) == 2
    assert len(hypotheses(belief, share=0.99, least_mass=0.3)) == 1
