"""Mission rule 6: what may be called localized, and the reasons why not yet."""

from dataclasses import replace

import numpy as np
import pytest

from planner.belief.estimate import estimate, mass_within
from planner.belief.grid import fold
from planner.belief.joint import joint_prior, update_joint
from planner.belief.verdict import best_crossing_angle, distinct_places, points_at, stated, verdict, wedges_meet
from planner.reasons import (
    BearingMissesArea,
    BearingsDisagree,
    CrossingAngleTooSmall,
    ErrorMayBeFarLarger,
    EstimateContradicted,
    ExpectedErrorTooLarge,
    NoBearingYet,
    TooFewPlaces,
)
from planner.types import Bearing, GaussianPrior, LinearMotion, LocalizationRule, Peak, Problem

SIGMA = np.deg2rad(4.0)
SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]])
PROBLEM = Problem(area=(SQUARE,), sigma=SIGMA, threshold=10.0, measurement_time=10.0, motion=LinearMotion(5.0))
RULE = LocalizationRule(threshold=10.0)
TARGET = (160.0, 170.0)


def toward(x, y, error=0.0, **more):
    return Bearing(x, y, float(np.arctan2(TARGET[1] - y, TARGET[0] - x)) + error, SIGMA, **more)


def judged(bearings, rule=RULE, problem=PROBLEM):
    return verdict(problem, rule, bearings, fold(problem, bearings))


def test_two_crossing_bearings_that_agree_are_a_localization():
    answer = judged([toward(160, 110), toward(100, 170)])
    assert answer.localized
    assert answer.consistent
    assert answer.reasons == ()


def test_without_bearings_nothing_is_claimed():
    assert judged([]).reasons == (NoBearingYet(),)


def test_one_place_is_never_enough_however_small_the_belief():
    narrow = Problem(
        area=(SQUARE,),
        sigma=SIGMA,
        threshold=10.0,
        measurement_time=10.0,
        motion=LinearMotion(5.0),
        prior=GaussianPrior(*TARGET, np.diag([1.0, 1.0])),
    )
    answer = judged([toward(160, 110)], problem=narrow)
    assert not answer.localized
    assert answer.reasons[0] == TooFewPlaces(bearings=1, places=1, needed_places=2)
    again = judged([toward(160, 110), toward(161, 110)], problem=narrow)
    assert again.reasons[0] == TooFewPlaces(bearings=2, places=1, needed_places=2)


def test_bearings_from_one_side_are_told_apart_from_crossing_ones():
    answer = judged([toward(160, 60), toward(175, 60)])
    assert not answer.localized
    flat = next(reason for reason in answer.reasons if isinstance(reason, CrossingAngleTooSmall))
    assert 0.0 < flat.crossing_deg < flat.needed_deg == pytest.approx(20.0)


def test_a_wide_belief_names_its_expected_error():
    answer = judged([toward(-200, 170), toward(160, -200)])
    assert not answer.localized
    last = answer.reasons[-1]
    assert isinstance(last, ExpectedErrorTooLarge)
    assert last.expected_error_m > last.threshold_m == 10.0


def test_inconsistent_bearings_are_never_a_localization():
    answer = verdict(PROBLEM, RULE, [toward(160, 110), toward(100, 170, np.pi)], None)
    assert not answer.localized
    assert not answer.consistent
    assert answer.reasons == (BearingsDisagree(2),)


def test_a_single_bearing_past_the_area_contradicts_nothing():
    answer = verdict(PROBLEM, RULE, [Bearing(350.0, 350.0, 0.0, SIGMA)], None)
    assert answer.reasons == (BearingMissesArea(),)


def test_an_outlier_asks_for_another_look_before_anything_is_claimed():
    modelled = {"outlier_probability": 0.05}
    two = [toward(160, 110, **modelled), toward(100, 170, **modelled)]
    wild = toward(220, 240, 2.0, **modelled)
    answer = judged([*two, wild])
    assert not answer.consistent
    assert not answer.localized
    assert EstimateContradicted(contradicting=1, bearings=3) in answer.reasons


def test_an_outlier_that_is_clearly_outnumbered_does_not_stop_the_mission():
    modelled = {"outlier_probability": 0.05}
    good = [toward(x, y, **modelled) for x, y in [(160, 110), (100, 170), (200, 200), (120, 220)]]
    answer = judged([*good, toward(220, 240, 2.0, **modelled)])
    assert answer.localized
    assert not answer.consistent


def test_an_outlier_into_a_corner_after_one_look_is_not_believed():
    """Two of the thesis' eleven flights failed so: a multipath outlier, the corner of the area, one measurement."""
    outlier = Bearing(280.0, 260.0, np.deg2rad(63.0), SIGMA, outlier_probability=0.05)
    answer = judged([outlier], rule=LocalizationRule(threshold=40.0))
    assert not answer.localized


def tailed(far, share):
    """A joint belief of two bearings that cross, its mass put at the target but for a share `far` m north of it."""
    belief = joint_prior(PROBLEM)
    for bearing in CROSSING:
        belief = update_joint(belief, bearing)
    x, y = belief.centres()
    column = int(np.abs(x - TARGET[0]).argmin())
    rows = [int(np.abs(y - wanted).argmin()) for wanted in (TARGET[1], TARGET[1] + far)]
    density = np.zeros_like(belief.density)
    density[rows, column] = 1.0 - share, share
    return replace(belief, density=density)


CROSSING = (toward(160, 110), toward(100, 170))


def test_a_far_tail_is_stated_and_stops_no_claim_while_it_lies_within_three_thresholds():
    near, light = (verdict(PROBLEM, RULE, CROSSING, tailed(24.0, share)) for share in (0.03, 0.01))
    assert near.localized
    assert near.estimate is not None
    assert light.estimate is not None
    assert near.estimate.expected_rmse == pytest.approx(8.0, abs=1.0)
    assert light.estimate.expected_rmse < 1.5
    (reason,) = verdict(PROBLEM, RULE, CROSSING, tailed(60.0, 0.03)).reasons
    assert isinstance(reason, ErrorMayBeFarLarger)
    assert (reason.beyond_percent, reason.far_m) == (pytest.approx(3.0), 30.0)
    assert verdict(PROBLEM, RULE, CROSSING, tailed(60.0, 0.01)).localized


@pytest.mark.parametrize("goal", [10.0, 5.0])
def test_three_times_what_is_stated_hold_a_line_as_far_as_the_goal_allows(goal):
    """All but 0.3 % of it, and on cells of some metres a little more."""
    belief = tailed(0.0, 0.0)
    _, y = belief.centres()
    along = np.exp(-0.5 * ((y - y[len(y) // 2]) / 6.0) ** 2)
    density = np.zeros_like(belief.density)
    density[:, belief.nx // 2] = along / along.sum()
    line = replace(belief, density=density)
    mean = estimate(line, PROBLEM.estimator)
    found = stated(line, mean, goal).expected_rmse
    assert found == pytest.approx(min(6.0, goal), rel=0.05)

    def beyond(error):
        return 1.0 - mass_within(line, mean.x, mean.y, 3.0 * error)

    assert beyond(mean.expected_rmse) > 0.01
    assert beyond(found) < 0.006


def test_an_error_that_is_too_large_is_named_as_it_is_stated():
    answer = verdict(PROBLEM, RULE, CROSSING, tailed(60.0, 0.25))
    (reason,) = answer.reasons
    assert answer.estimate is not None
    assert reason == ExpectedErrorTooLarge(answer.estimate.expected_rmse, 10.0)
    assert answer.estimate.expected_rmse == pytest.approx(20.0, abs=1.0), "the mean distance is 15 m"


def test_a_bearing_that_supports_by_another_peak_does_not_disagree():
    """Its main peak is a reflection: where that points no emitter is looked for, nor is the claim held up."""
    towards = float(np.arctan2(TARGET[1] - 60.0, TARGET[0] - 200.0))
    reflected = Bearing(200.0, 60.0, towards + np.pi, SIGMA, peaks=(Peak(towards, 0.4),), outlier_probability=0.05)
    bearings = [*(replace(b, outlier_probability=0.05) for b in CROSSING), reflected]
    answer = judged(bearings)
    assert not answer.consistent
    assert answer.localized


def test_any_peak_of_a_sweep_supports_the_estimate():
    two_peaks = Bearing(0.0, 0.0, np.pi, SIGMA, peaks=(Peak(0.0, 0.4),))
    assert points_at(two_peaks, 50.0, 0.0)
    assert not points_at(two_peaks, 0.0, 50.0)


def test_wedges_that_meet_only_outside_the_area_do_not_meet():
    assert wedges_meet((SQUARE,), [toward(160, 110), toward(100, 170)])
    beyond = [Bearing(150.0, 0.0, np.deg2rad(70), 0.01), Bearing(0.0, 150.0, np.deg2rad(45), 0.01)]
    assert not wedges_meet((SQUARE,), beyond)


def test_lines_cross_at_the_acute_angle():
    assert best_crossing_angle([toward(160, 0), toward(160, 300)], *TARGET) == pytest.approx(0.0, abs=1e-9)
    assert best_crossing_angle([toward(160, 0), toward(0, 170)], *TARGET) == pytest.approx(np.pi / 2)


def test_places_closer_than_the_distance_count_once():
    assert distinct_places([toward(0, 0), toward(5, 0), toward(20, 0)], 10.0) == 2
