"""A stretch of way says what a brute-force sum says, and never more than a bearing would."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.belief import compiled_evidence, evidence
from planner.belief.evidence import sightings
from planner.belief.source_errors import ErrorPrior, nodes
from planner.on_the_way import (
    FREEDOM,
    NEAR_M,
    RING,
    RING_M,
    Stretch,
    heard,
    log_ratio,
    nearest,
    variance_of,
    worth_of,
)
from planner.types import Bearing

AHEAD = tuple((-np.minimum(12.0 * (((np.arange(36) + 18) % 36 - 18) / 6.5) ** 2, 15.0)).tolist())
SIGMA = math.radians(6.0)
ONE = np.ones(1)


def stretch(turned_deg: float = 150.0, emitter: tuple[float, float] = (80.0, 90.0), noise: float = 0.0, seed: int = 1):
    """Readings along 20 m eastward, the antenna turning meanwhile; -40 dB at 1 m."""
    rng = np.random.default_rng(seed)
    x, front = np.linspace(0.0, 20.0, 14), np.radians(np.linspace(10.0, 10.0 + turned_deg, 14))
    off = np.array(emitter)[:, None] - np.array([x, np.zeros(14)])
    relative = np.arctan2(off[1], off[0]) - front
    gain = np.interp(relative / (2.0 * np.pi) % 1.0, np.arange(36) / 36, AHEAD, period=1.0)
    power = -40.0 + gain - 20.0 * np.log10(np.hypot(*off)) + noise * rng.standard_normal(14)
    return Stretch("craft", tuple(x), (0.0,) * 14, tuple(front), tuple(power), AHEAD, SIGMA)


def brute_force(one: Stretch, x: float, y: float, bias: float, scale: float) -> float:
    """log of the integral over the level and over the spread, by sums, up to a constant that no place changes."""
    found = heard([one], ONE)
    n, worth = len(one.x), float(found.worth[0])
    off_x, off_y = x - np.array(one.x), y - np.array(one.y)
    gain = found.gain[0, nearest(np.arctan2(off_y, off_x) - np.array(one.front) + bias)]
    mean, variance = gain - 20.0 * np.log10(np.hypot(off_x, off_y)), variance_of(gain)
    level = np.linspace(-220.0, 140.0, 20_001)
    square = ((np.array(one.power_db) - mean - level[:, None]) ** 2 / variance).sum(axis=1)
    spread = scale**2 * np.geomspace(1e-3, 1e4, 2_001)  # t^2
    log_of_spread = np.empty(spread.size)
    for k, t2 in enumerate(spread):
        log = -0.5 * square / t2 - 0.5 * np.log(2.0 * np.pi * t2 * variance).sum()
        top = log.max()
        marginal = top + np.log(np.trapezoid(np.exp(log - top), level))
        log_of_spread[k] = marginal * worth / (n - 1)
        # scaled inverse chi squared, its 1 / t^2 taken by the geometric steps
        log_of_spread[k] += -0.5 * FREEDOM * np.log(t2 / scale**2) - 0.5 * FREEDOM * scale**2 / t2
    top = log_of_spread.max()
    return float(top + np.log(np.exp(log_of_spread - top).sum()))


def test_a_stretch_says_what_the_sum_over_levels_and_spreads_says() -> None:
    one = stretch(noise=3.0)
    at = [(80.0, 90.0, 0.0), (-120.0, 60.0, 0.0), (60.0, -90.0, 0.1), (200.0, 10.0, -0.15)]
    for scale in (0.7, 1.45):
        found = heard([one], np.array([scale]))
        said = [
            float(log_ratio(np.array([x]), np.array([y]), found, np.array([b]), np.array([scale]))[0, 0, 0, 0])
            for x, y, b in at
        ]
        summed = [brute_force(one, x, y, b, scale) for x, y, b in at]
        assert np.diff(said) == pytest.approx(np.diff(summed), abs=2e-3)
        assert max(np.abs(np.diff(said))) > 0.3


def test_its_mean_over_directions_is_one() -> None:
    angle = 2.0 * np.pi * np.arange(RING) / RING
    x, y = 10.0 + RING_M * np.cos(angle), RING_M * np.sin(angle)
    for scale in (np.array([0.7, 1.0, 1.45]),):
        ratio = np.exp(log_ratio(x, y, heard([stretch()], scale), np.zeros(1), scale))
        assert ratio[0, :, :, 0].mean(axis=0) == pytest.approx(1.0)


@given(st.integers(0, 200), st.floats(0.0, 360.0), st.floats(1.0, 20.0))
def test_it_is_never_worth_more_than_a_bearing_or_its_turn(seed: int, turned_deg: float, sigma_deg: float) -> None:
    one = replace(stretch(turned_deg, noise=2.0, seed=seed), sigma=math.radians(sigma_deg))
    worth = worth_of(one)
    assert worth <= turned_deg / 50.0 + 1e-9
    found = heard([one], ONE)
    angle = 2.0 * np.pi * np.arange(RING) / RING
    x, y = np.mean(one.x) + RING_M * np.cos(angle), RING_M * np.sin(angle)
    highest = np.exp(log_ratio(x, y, found, np.zeros(1), ONE)).max(initial=1.0)
    assert highest <= math.sqrt(2.0 * math.pi) / one.sigma * 1.001


def test_an_antenna_that_points_one_way_tells_nothing() -> None:
    assert len(heard([stretch(turned_deg=0.0), stretch(turned_deg=8.0)], ONE).worth) == 0


def test_what_was_sent_and_what_shadows_a_stretch_do_not_count() -> None:
    one = stretch(noise=2.0)
    louder = replace(one, power_db=tuple(p + 17.0 for p in one.power_db))
    x, y = np.random.default_rng(2).uniform(-200.0, 200.0, (2, 30))
    said = [log_ratio(x, y, heard([some], ONE), np.zeros(1), ONE) for some in (one, louder)]
    assert said[0] == pytest.approx(said[1], abs=1e-9)


def test_an_emitter_below_the_way_is_not_judged() -> None:
    near = np.array([5.0, 25.0]), np.array([NEAR_M - 1.0, -3.0])
    assert (log_ratio(*near, heard([stretch()], ONE), np.zeros(1), ONE) == 0.0).all()


def test_a_place_in_the_right_direction_gains_and_a_turned_compass_is_seen() -> None:
    found, bias = heard([stretch(240.0)], ONE), np.radians(np.arange(-30.0, 31.0, 2.0))
    there, behind = log_ratio(np.array([80.0, -60.0]), np.array([90.0, -90.0]), found, np.zeros(1), ONE)[0, :, 0, 0]
    assert there > 0.7 > behind + 0.7
    turned = replace(stretch(240.0), front=tuple(a + math.radians(12.0) for a in stretch(240.0).front))
    said = log_ratio(np.array([80.0]), np.array([90.0]), heard([turned], ONE), bias, ONE)[0, 0, 0]
    assert bias[said.argmax()] == pytest.approx(math.radians(12.0), abs=math.radians(4.0))


def test_the_compiled_evidence_is_that_of_the_readable_one() -> None:
    rng = np.random.default_rng(5)
    x, y = rng.uniform(-150.0, 250.0, (2, 60))
    stretches = [stretch(turned, noise=3.0, seed=k) for k, turned in enumerate((90.0, 200.0, 40.0, 330.0))]
    bearing = Bearing(0.0, 0.0, 0.8, SIGMA, source="craft")
    for taken in ([], [bearing]):
        grid = nodes(ErrorPrior(), SIGMA, 40, even=True)
        fast = compiled_evidence.evidence(x, y, sightings(taken), grid, stretches)
        plain = evidence.evidence(x, y, sightings(taken), grid, stretches)
        without = evidence.evidence(x, y, sightings(taken), grid)
        assert fast.log == pytest.approx(plain.log, abs=0.05)
        for ours, theirs in zip(fast[1:], plain[1:], strict=True):
            assert ours == pytest.approx(theirs, abs=0.01)
        assert np.ptp(plain.log - without.log) > 1.0


def test_places_shared_out_to_threads_are_those_of_the_readable_one() -> None:
    rng = np.random.default_rng(8)
    x, y = rng.uniform(-150.0, 250.0, (2, 2 * compiled_evidence.WORTH_A_THREAD + 1))
    stretches, grid = (
        [stretch(200.0, noise=3.0), stretch(330.0, noise=3.0, seed=2)],
        nodes(ErrorPrior(), SIGMA, 4, even=True),
    )
    seen = sightings([Bearing(0.0, 0.0, 0.8, SIGMA, source="craft")])
    fast, plain = (way.Weigher(seen, grid, stretches) for way in (compiled_evidence, evidence))
    assert fast.log(x, y) == pytest.approx(plain.log(x, y), abs=0.05)
    mass = rng.dirichlet(np.ones(len(x)))
    for ours, theirs in zip(fast.shared_out(x, y, mass), plain.shared_out(x, y, mass), strict=True):
        assert ours == pytest.approx(theirs, abs=0.01)


def test_places_that_are_kept_no_more_are_weighed_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled_evidence, "MOST_KEPT", 50)
    x, y = np.random.default_rng(10).uniform(-150.0, 250.0, (2, 90))
    seen, grid = sightings([Bearing(0.0, 0.0, 0.8, SIGMA, source="craft")]), nodes(ErrorPrior(), SIGMA, 4, even=True)
    in_calls, at_once = (compiled_evidence.Weigher(seen, grid, [stretch(200.0, noise=3.0)]) for _ in range(2))
    for part in (slice(0, 30), slice(30, 60), slice(60, 75), slice(75, 90)):
        in_calls.log(x[part], y[part])
    mass = np.full(30, 1 / 30)
    with monkeypatch.context() as still_kept:
        still_kept.setattr(compiled_evidence, "_told", None)
        in_calls.shared_out(x[60:], y[60:], mass)
    for part in (slice(60, 90), slice(0, 30)):
        told = (one.shared_out(x[part], y[part], mass) for one in (in_calls, at_once))
        for ours, theirs in zip(*told, strict=True):
            assert ours == pytest.approx(theirs, rel=1e-12)


def test_a_stretch_that_fits_nowhere_speaks_as_loud_as_an_outlier_and_leaves_numbers() -> None:
    wild = replace(stretch(330.0), power_db=tuple(1e6 * (-1.0) ** k for k in range(len(stretch(330.0).power_db))))
    grid = nodes(ErrorPrior(), SIGMA, 4, even=True)
    x, y = np.random.default_rng(9).uniform(-150.0, 250.0, (2, 20))
    log = compiled_evidence.Weigher(sightings([]), grid, [wild, stretch(90.0)]).log(x, y)
    assert np.isfinite(log).all()


def test_hundreds_of_stretches_stay_within_the_range_of_numbers() -> None:
    """A mission of twenty legs of 480 m has as many."""
    x, y = np.array([80.0, -120.0, 200.0]), np.array([90.0, 60.0, -10.0])
    stretches = [stretch(330.0, noise=2.0, seed=k) for k in range(900)]
    grid = nodes(ErrorPrior(), SIGMA, 900, even=True)
    fast = compiled_evidence.evidence(x, y, sightings([]), grid, stretches)
    plain = evidence.evidence(x, y, sightings([]), grid, stretches)
    assert np.ptp(plain.log) > 710.0, "the case would show nothing"
    assert fast.log == pytest.approx(plain.log, rel=0.02)
    assert all(np.isfinite(part).all() for part in fast)
    told = compiled_evidence.node_evidence(x, y, np.zeros(3), sightings([]), grid, stretches)
    assert np.isfinite(told).all()


def test_one_wrong_stretch_is_one_outlier() -> None:
    """However many readings it has, it cannot speak against a place louder than an outlier's rate allows."""
    grid = nodes(ErrorPrior(rate=np.array([0.1]), rate_weight=ONE), SIGMA, 5)
    x, y = np.random.default_rng(6).uniform(-300.0, 300.0, (2, 200))
    log = evidence.evidence(x, y, sightings([]), grid, [stretch(330.0)]).log
    assert log.min() > math.log(0.1) - 1e-9
