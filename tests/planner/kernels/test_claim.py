"""The chance of a claim: the compiled twin counts as the readable one, and both as a Gaussian says."""

import numpy as np
import pytest

from planner.kernels.claim import BiasedCells, ClaimRule, Draws, claim_chances, claim_chances_reference


def belief(rng, count=80):
    x, y = rng.normal(20.0, 15.0, count), rng.normal(-40.0, 6.0, count)
    mass = rng.exponential(1.0, count) ** 2
    bias = np.deg2rad(rng.normal(0.0, 3.0, count))
    variance = np.deg2rad(rng.uniform(2.0, 6.0, count)) ** 2
    return BiasedCells(x, y, mass / mass.sum(), bias, variance, rng.uniform(0.0, 4.0, count))


def draws(rng, count=24):
    return Draws(rng.integers(0, 80, count), rng.standard_normal(count))


@pytest.mark.parametrize("seed", range(6))
def test_compiled_and_readable_count_alike(seed):
    rng = np.random.default_rng(seed)
    cells, taken = belief(rng), draws(rng)
    places = np.vstack([rng.uniform(-150.0, 150.0, (30, 2)), [[cells.x[3], cells.y[3]]]])
    rules = [ClaimRule(threshold, 3.0, 0.02) for threshold in (4.0, 8.0, 14.0)]
    found = [claim_chances(cells, places, taken, 0.1, rule) for rule in rules]
    for rule, one in zip(rules, found, strict=True):
        plain = claim_chances_reference(cells, places, taken, 0.1, rule)
        assert one.chance == pytest.approx(plain.chance, abs=1e-12)
        assert one.tail == pytest.approx(plain.tail, abs=1e-9)
    assert 0.0 <= found[0].chance.mean() < found[1].chance.mean() < found[2].chance.mean() <= 0.9


def line(bias):
    """Two places, ten m apart along x, one certain bias each."""
    return BiasedCells(
        np.array([0.0, 10.0]),
        np.zeros(2),
        np.array([0.5, 0.5]),
        np.array([0.0, bias]),
        np.full(2, np.deg2rad(1.0) ** 2),
        np.zeros(2),
    )


def test_a_bias_that_hides_a_place_from_one_side_shows_it_from_the_other():
    """From the south the place to the east looks as far to the left as its bias turns it: both look alike."""
    taken = Draws(np.array([0, 1, 0, 1]), np.array([0.0, 0.0, 0.3, -0.3]))
    rule = ClaimRule(threshold=1.0, far=3.0, beyond=1.0)
    places = np.array([[0.0, -100.0], [0.0, 100.0]])
    hidden = float(np.arctan2(10.0, 100.0))
    south, north = claim_chances(line(hidden), places, taken, 0.0, rule).chance
    assert (south, north) == (0.0, 1.0)
    assert claim_chances(line(0.0), places, taken, 0.0, rule).chance.tolist() == [1.0, 1.0]


def test_the_tail_that_is_left_is_that_of_the_belief_after_the_bearing():
    """An emitter at 0, or with one in ten 40 m to the east: from the south the next bearing tells which, along the line
    it does not. Without errors of its own the first leaves what the rule allows, the second all of it."""
    cells = line(0.0)._replace(x=np.array([0.0, 40.0]), mass=np.array([0.9, 0.1]))
    taken = Draws(np.zeros(4, dtype=np.int64), np.zeros(4))
    across, along = claim_chances(
        cells, np.array([[0.0, -50.0], [-100.0, 0.0]]), taken, 0.0, ClaimRule(10.0, 3.0, 0.01)
    ).tail
    assert across == pytest.approx(np.log(0.01))
    assert along == pytest.approx(np.log(0.1))
