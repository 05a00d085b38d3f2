"""Bearings narrower than a cell are crossed where they cross, and not where a cell's centre lies."""

import math

import numpy as np
import pytest

from planner.belief.estimate import estimate
from planner.belief.joint import JointBelief, joint_prior, update_joint
from planner.belief.sharp import crossings
from planner.belief.verdict import stated
from planner.types import Bearing, LinearMotion, Problem

SIGMA = math.radians(2.0)


def around(target: tuple[float, float], away_m: float, seed: int, count: int = 5) -> list[Bearing]:
    rng = np.random.default_rng(seed)
    found: list[Bearing] = []
    for k in range(count):
        turn = 2.0 * math.pi * k / count + rng.uniform(0.0, 1.0)
        x, y = target[0] + away_m * math.cos(turn), target[1] + away_m * math.sin(turn)
        found.append(Bearing(x, y, turn + math.pi + rng.normal(0.0, SIGMA), SIGMA, source="craft"))
    return found


def searched(half_m: float, bearings: list[Bearing]) -> tuple[Problem, JointBelief]:
    square = np.array([[-half_m, -half_m], [half_m, -half_m], [half_m, half_m], [-half_m, half_m]])
    problem = Problem(area=(square,), sigma=SIGMA, threshold=10.0, measurement_time=10.0, motion=LinearMotion(5.0))
    belief = joint_prior(problem)
    for bearing in bearings:
        belief = update_joint(belief, bearing)
    return problem, belief


@pytest.mark.parametrize("half_m", [200.0, 500.0, 1000.0])
@pytest.mark.parametrize("seed", range(4))
def test_sharp_bearings_from_near_find_the_emitter_in_a_large_area(half_m: float, seed: int) -> None:
    """Five of 2 degrees from 60 m away: in 2 km they stated 360 to 580 m, in 1 km 0.2 m where they were off by 3."""
    target = tuple(np.random.default_rng(seed).uniform(-50.0, 50.0, 2).tolist())
    problem, belief = searched(half_m, around(target, 60.0, seed))
    mean = estimate(belief, problem.estimator)
    said = stated(belief, mean, 10.0)
    assert said.expected_rmse < 6.0
    assert math.dist((said.x, said.y), target) < 3.0 * said.expected_rmse


def test_every_two_bearings_cross_at_the_emitter_and_elsewhere_where_the_compass_is_off() -> None:
    found = crossings([Bearing(-60.0, 0.0, 0.0, SIGMA), Bearing(0.0, -60.0, math.pi / 2.0, SIGMA)])
    at_it = np.hypot(found.x, found.y) < 1e-9
    assert at_it.sum() == 1
    assert found.width[at_it] == pytest.approx(60.0 * SIGMA)
    # of an angle that is inscribed: all on the circle through both places and the emitter
    assert np.hypot(found.x + 30.0, found.y + 30.0) == pytest.approx(math.hypot(30.0, 30.0))
    assert len(found.within(-1.0, -1.0, 1.0, 1.0).x) < len(found.x)


def test_bearings_that_do_not_cross_ask_for_nothing() -> None:
    north = Bearing(0.0, 0.0, math.pi / 2.0, SIGMA)
    for bearings in ([], [north], [north, north]):
        assert crossings(bearings).resolved(1e3)
    parallel = [Bearing(0.0, y, 0.0, SIGMA) for y in (0.0, 50.0)]
    assert len(crossings(parallel).x) == 0


def test_cells_that_are_fine_enough_stay_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in the area that is suggested: beliefs of journals are what they were."""
    bearings = around((10.0, 20.0), 100.0, 1)
    _, belief = searched(160.0, bearings)
    monkeypatch.setattr("planner.belief.joint.crossings", lambda _: crossings([]))
    _, without = searched(160.0, bearings)
    assert np.array_equal(belief.density, without.density)
