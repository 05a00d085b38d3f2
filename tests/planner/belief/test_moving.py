"""The belief about an emitter that moves: what it must share with the still one, and what time does to it."""

from dataclasses import replace
from time import process_time

import numpy as np
import pytest

from planner.belief.estimate import estimate, mass_within
from planner.belief.grid import fold
from planner.belief.moving import MOST_CELLS, Assumed, moving_prior, predicted, update_moving
from planner.belief.source_errors import ErrorPrior
from planner.belief.verdict import verdict
from planner.movement import DRIFTING_S, WALKING_S, Movement
from planner.study.walkers import Walker, walker
from planner.types import Bearing, LinearMotion, LocalizationRule, Peak, Problem

AREA = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 200.0], [0.0, 200.0]])
PROBLEM = Problem((AREA,), sigma=0.12, threshold=10.0, measurement_time=30.0, motion=LinearMotion(7.0))
STILL = Movement(1e-9, 30.0)


def towards(x: float, y: float, target: tuple[float, float], at: float, **more: object) -> Bearing:
    angle = float(np.arctan2(target[1] - y, target[0] - x))
    return Bearing(x, y, angle, 0.1, outlier_probability=0.1, taken_at=at, **more)  # type: ignore[arg-type]


def folded(movement: Movement, *bearings: Bearing, otherwise: ErrorPrior | None = None):
    belief = moving_prior(PROBLEM, Assumed(movement, otherwise=otherwise))
    for bearing in bearings:
        belief = update_moving(belief, bearing)
    return belief


CROSS = (towards(0, -30, (150, 120), 0.0), towards(290, -30, (150, 120), 45.0), towards(150, 230, (150, 120), 90.0))


def test_of_an_emitter_that_stands_still_it_says_what_the_still_belief_says() -> None:
    peaks = (Peak(2.9, 0.5),)
    bearings = (CROSS[0], towards(290, -30, (150, 120), 45.0, peaks=peaks), CROSS[2])
    moving, still = folded(STILL, *bearings), fold(PROBLEM, bearings)
    a, b = (estimate(belief, "geometric_median") for belief in (moving, still))
    assert (a.x, a.y) == pytest.approx((b.x, b.y), abs=0.05)
    assert a.expected_rmse == pytest.approx(b.expected_rmse, rel=1e-3)
    assert a.covariance == pytest.approx(b.covariance, rel=1e-3, abs=0.05)


@pytest.mark.parametrize("movement", [Movement(0.4, WALKING_S), Movement(0.2, DRIFTING_S)])
def test_what_is_known_wears_off_with_time_as_fast_as_the_emitter_may_go(movement: Movement) -> None:
    belief = folded(movement, *CROSS, *(towards(80, 60, (150, 120), 135.0), towards(220, 60, (150, 120), 180.0)))
    spread = [estimate(predicted(belief, after), "expected_value") for after in (0.0, 60.0, 240.0)]
    errors = [one.expected_rmse for one in spread]
    assert errors == sorted(errors)
    grown = np.trace(spread[2].covariance) - np.trace(spread[0].covariance)
    assert 0.0 < grown <= 1.6 * movement.way(240.0) ** 2 + 1.0
    assert predicted(belief, 0.0) is belief


def test_a_drift_is_recognized_and_foreseen() -> None:
    """One that went east all the time is expected further east, not where it was last."""
    movement = Movement(0.4, DRIFTING_S)
    where = [(60.0 + 0.4 * t, 100.0) for t in range(0, 400, 40)]
    stations = [(0.0, -40.0), (200.0, -40.0), (100.0, 240.0)]
    bearings = [
        replace(towards(*stations[k % 3], target, 40.0 * k), sigma=0.03, outlier_probability=0.02)
        for k, target in enumerate(where)
    ]
    now = folded(movement, *bearings)
    later = predicted(now, 100.0)
    before, after = (estimate(one, "expected_value") for one in (now, later))
    assert before.x == pytest.approx(where[-1][0], abs=12.0)
    assert after.x - before.x == pytest.approx(40.0, abs=20.0)


def test_the_order_of_arrival_does_not_matter() -> None:
    movement = Movement(0.3, WALKING_S)
    a, b = folded(movement, *CROSS), folded(movement, CROSS[2], CROSS[0], CROSS[1])
    assert a.now == b.now == 90.0
    assert np.array_equal(a.density, b.density)


def test_a_bias_of_the_source_is_found_though_the_emitter_moves() -> None:
    """From all sides, every bearing turned by 8 degrees."""
    turned, target = np.deg2rad(8.0), (150.0, 100.0)
    sides = [(40.0, 100.0), (150.0, 0.0), (260.0, 100.0), (150.0, 200.0), (70.0, 30.0), (230.0, 170.0)]
    right = [towards(x, y, target, 40.0 * k, source="craft:1") for k, (x, y) in enumerate(sides)]
    bearings = [replace(one, angle=one.angle + turned, sigma=0.05) for one in right]
    belief = folded(Movement(0.1, WALKING_S), *bearings, otherwise=ErrorPrior())
    found = belief.errors_of("craft:1")
    assert found is not None
    assert np.rad2deg(found.bias) == pytest.approx(8.0, abs=3.0)
    assert mass_within(belief, *target, 25.0) > 0.9


def test_old_bearings_prove_no_place() -> None:
    """Two bearings that crossed half an hour ago leave nothing to claim by."""
    movement = Movement(0.4, WALKING_S)
    rule = LocalizationRule(threshold=1000.0)
    belief = folded(movement, *CROSS)
    assert verdict(PROBLEM, rule, CROSS, belief).localized
    late = predicted(belief, 1800.0)
    said = verdict(PROBLEM, rule, CROSS, late)
    assert not said.localized


@pytest.mark.parametrize("kind", ["walker", "drifter"])
def test_walkers_keep_their_pace_and_their_way(kind: str) -> None:
    one = walker(kind, np.array([10.0, 20.0]), 0.4, np.random.default_rng(3))  # type: ignore[arg-type]
    late, early = one.at(500.0), one.at(10.0)
    assert np.array_equal(one.at(500.0), late)
    assert np.array_equal(one.at(0.0), [10.0, 20.0])
    assert float(np.hypot(*(early - one.at(9.0)))) <= 0.4 + 1e-9
    straight = float(np.hypot(*(late - one.at(0.0))))
    assert straight <= 0.4 * 500.0 + 1e-9


def test_the_way_gone_is_that_of_walkers() -> None:
    """Root mean square over walkers whose directions are forgotten after half a minute: the theory's."""
    ways = [
        float(np.hypot(*Walker(np.zeros(2), 0.4, 30.0, np.random.default_rng(seed)).at(120.0))) for seed in range(400)
    ]
    assert np.sqrt(np.mean(np.square(ways))) == pytest.approx(Movement(0.4, 30.0).way(120.0), rel=0.08)


@pytest.mark.parametrize("age_s", [86_400.0, 1.76e9])
def test_a_bearing_however_old_costs_no_more_than_a_new_one(age_s: float) -> None:
    """One of yesterday, or one of which nobody said when: neither fills the memory nor stops the search."""
    movement = Movement(0.4, DRIFTING_S)
    new = tuple(replace(one, taken_at=age_s + one.taken_at) for one in CROSS)
    began = process_time()
    belief = folded(movement, towards(80, 60, (150, 120), 0.0), *new)
    assert process_time() - began < 20.0
    assert belief.density.size <= 4 * MOST_CELLS
    assert mass_within(belief, 150, 120, 60.0) > 0.5
