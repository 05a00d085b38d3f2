from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.belief.grid import GridBelief, prior_belief
from planner.directions import DIRECTIONS, expected_directions, shortest_arc
from planner.types import GaussianPrior, LinearMotion, Problem

SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]])
PROBLEM = Problem((SQUARE,), sigma=0.1, threshold=5.0, measurement_time=1.0, motion=LinearMotion(5.0))


def around(x: float, y: float, sd: float = 5.0) -> GridBelief:
    prior = GaussianPrior(x, y, np.diag([sd**2, sd**2]))
    return prior_belief(replace(PROBLEM, prior=prior))


@given(st.floats(0.0, 2.0 * math.pi), st.floats(0.02, 0.3))
def test_the_directions_point_where_the_belief_lies_as_widely_as_a_bearing_errs(angle: float, sigma: float) -> None:
    belief = around(150.0, 150.0, 2.0)
    place = (150.0 - 120.0 * math.cos(angle), 150.0 - 120.0 * math.sin(angle))
    mass = expected_directions(belief, place, sigma)
    assert mass.sum() == pytest.approx(1.0)
    at = 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    mean = np.angle(np.sum(mass * np.exp(1j * at)))
    assert math.remainder(mean - angle, 2.0 * math.pi) == pytest.approx(0.0, abs=0.02)
    off = np.angle(np.exp(1j * (at - angle)))
    spread = math.sqrt(float(mass @ off**2))
    assert spread == pytest.approx(math.hypot(sigma, 2.0 / 120.0), abs=0.02)


def test_a_place_above_the_emitter_expects_it_all_round() -> None:
    belief = around(150.0, 150.0, 0.5)
    inside = expected_directions(belief, (150.0, 150.0), 0.05)
    outside = expected_directions(belief, (150.0, 20.0), 0.05)
    assert shortest_arc(inside, 0.9).width > math.radians(180.0)
    assert shortest_arc(outside, 0.9).width < math.radians(30.0)


@given(st.integers(0, 359), st.integers(1, 200))
def test_the_shortest_arc_is_found_across_north_too(begin: int, width: int) -> None:
    mass = np.zeros(DIRECTIONS)
    mass[(begin + np.arange(width)) % DIRECTIONS] = 1.0 / width
    arc = shortest_arc(mass, 1.0)
    assert math.degrees(arc.width) == pytest.approx(width)
    assert math.remainder(math.degrees(arc.begin) - (begin - 0.5), 360.0) == pytest.approx(0.0, abs=1e-6)


@given(st.lists(st.floats(0.0, 1.0), min_size=36, max_size=36).filter(lambda m: sum(m) > 0.1), st.floats(0.05, 0.99))
def test_no_shorter_arc_holds_as_much(weights: list[float], share: float) -> None:
    mass = np.repeat(np.array(weights), 10) / (10.0 * sum(weights))
    arc = shortest_arc(mass, share)
    cells = round(math.degrees(arc.width))
    begin = round(math.degrees(arc.begin) + 0.5)
    assert mass[(begin + np.arange(cells)) % DIRECTIONS].sum() >= share - 1e-9
    shorter = [mass[(k + np.arange(cells - 1)) % DIRECTIONS].sum() for k in range(DIRECTIONS)]
    assert max(shorter) < share + 1e-9
