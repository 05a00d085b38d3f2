"""Bearings narrower than a cell are crossed where they cross, and not where a cell's centre lies."""

import math
from dataclasses import replace

import numpy as np
import pytest

from planner.belief.estimate import estimate
from planner.belief.joint import JointBelief, joint_prior, update_joint
from planner.belief.same_place import one_a_place
from planner.belief.shared_source import common_nodes, node_evidence
from planner.belief.sharp import crossings
from planner.belief.verdict import stated
from planner.types import Bearing, LinearMotion, Problem

SIGMA = math.radians(2.0)


def around(
    target: tuple[float, float], away_m: float, seed: int, count: int = 5, sigma: float = SIGMA
) -> list[Bearing]:
    rng = np.random.default_rng(seed)
    found: list[Bearing] = []
    for k in range(count):
        turn = 2.0 * math.pi * k / count + rng.uniform(0.0, 1.0)
        x, y = target[0] + away_m * math.cos(turn), target[1] + away_m * math.sin(turn)
        found.append(Bearing(x, y, turn + math.pi + rng.normal(0.0, sigma), sigma, source="craft"))
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


def test_a_station_that_is_heard_often_hides_no_other() -> None:
    two = [Bearing(-60.0, 0.0, 0.0, SIGMA), Bearing(0.0, -60.0, math.pi / 2.0, SIGMA)]
    station = Bearing(60.0, 0.0, 3.0, SIGMA)
    found = crossings([*two, *[station] * 30])
    assert np.hypot(found.x, found.y).min() < 1e-9
    assert len(found.x) == len(crossings([*two, station]).x)


def test_sharp_bearings_are_crossed_however_many_others_come_after() -> None:
    two = [Bearing(-60.0, 0.0, 0.0, SIGMA), Bearing(0.0, -60.0, math.pi / 2.0, SIGMA)]
    others = [Bearing(300.0 + 20.0 * k, 300.0, 4.0, 3.0 * SIGMA) for k in range(20)]
    found = crossings([*two, *others])
    assert np.hypot(found.x, found.y).min() < 1e-9


def test_bearings_that_do_not_cross_ask_for_nothing() -> None:
    north = Bearing(0.0, 0.0, math.pi / 2.0, SIGMA)
    for bearings in ([], [north], [north, north], [north, Bearing(0.0, 0.0, 1.0, SIGMA)]):
        assert len(crossings(bearings).x) == 0
    parallel = [Bearing(0.0, y, 0.0, SIGMA) for y in (0.0, 50.0)]
    assert len(crossings(parallel).x) == 0


@pytest.mark.parametrize(("half_m", "most"), [(2000.0, 10.0), (3000.0, 20.0)])
def test_in_areas_of_kilometres_too(half_m: float, most: float) -> None:
    """Of 0.3 degrees from 20 m away they stated 1114 and 2197 m; of 2 degrees from 60 m 3.8 and 5.7 m, where exact
    sums on finer and finer cells leave 7.9 and 13.9: outliers far away count, too."""
    target = tuple(np.random.default_rng(7).uniform(-half_m / 4.0, half_m / 4.0, 2).tolist())
    problem, belief = searched(half_m, around(target, 20.0, 3, sigma=math.radians(0.3)))
    assert stated(belief, estimate(belief, problem.estimator), 10.0).expected_rmse < 10.0
    problem, belief = searched(half_m, around(target, 60.0, 3))
    assert 6.0 < stated(belief, estimate(belief, problem.estimator), 10.0).expected_rmse < most


@pytest.mark.parametrize(("half_m", "least", "most"), [(100.0, 0.1, 0.5), (500.0, 0.2, 1.5), (1000.0, 0.5, 3.0)])
def test_bearings_from_next_to_the_emitter_cross_too(half_m: float, least: float, most: float) -> None:
    """Of 2 degrees from 5 m away, all from places that count for themselves: 69, 531 and 1061 m were stated where sums
    on cells of centimetres leave 0.2, 0.2 and 0.5."""
    target = tuple(np.random.default_rng(7).uniform(-half_m / 4.0, half_m / 4.0, 2).tolist())
    bearings = around(target, 5.0, 52)
    assert len(one_a_place(bearings)) == len(bearings)
    problem, belief = searched(half_m, bearings)
    assert least < stated(belief, estimate(belief, problem.estimator), 10.0).expected_rmse < most


def test_a_wide_belief_asks_for_no_finer_cells() -> None:
    """Bearings of 10 degrees from 20 m away leave 1 km to the outliers, as coarse as any belief."""
    _, belief = searched(1000.0, around((10.0, 20.0), 20.0, 3, sigma=math.radians(10.0)))
    assert belief.density.size <= 40_000


def test_cells_that_are_fine_enough_stay_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in the area that is suggested: beliefs of journals are what they were."""
    bearings = around((10.0, 20.0), 100.0, 1)
    _, belief = searched(160.0, bearings)
    monkeypatch.setattr("planner.belief.joint.crossings", lambda _: crossings([]))
    _, without = searched(160.0, bearings)
    assert np.array_equal(belief.density, without.density)


@pytest.mark.parametrize("half_m", [500.0, 1000.0, 3000.0])
def test_what_it_tells_others_of_the_compass_is_what_it_knows_itself(half_m: float) -> None:
    """Of 1 degree from 20 m away, all turned by 8: others were told 9.1 +- 3.4 in 2 km and -0.2 +- 4.9 in 6 km."""
    sigma = math.radians(1.0)
    turned = [replace(b, angle=b.angle + math.radians(8.0)) for b in around((20.0, 30.0), 20.0, 3, 6, sigma)]
    _, belief = searched(half_m, turned)
    (own,) = belief.errors
    grid = common_nodes([belief], "craft")
    log = node_evidence(belief, "craft", grid)
    mass = (grid.weight * np.exp(log - log.max())).sum(axis=(0, 1))
    mass /= mass.sum()
    told = float(mass @ grid.bias)
    assert told == pytest.approx(own.bias, abs=math.radians(0.1))
    assert math.sqrt(mass @ (grid.bias - told) ** 2) == pytest.approx(own.bias_sd, rel=0.1)
