"""The ellipse policy and its table."""

import json

import numpy as np
import pytest

from planner.belief.grid import prior_belief
from planner.policy.ellipse import ellipse, table
from planner.policy.ellipse_table import RATIOS, SIGMAS_DEG, TABLE, compute, expected_rmse_after
from planner.types import GaussianPrior, LinearMotion, Problem

SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]])
SIGMA = np.deg2rad(4.0)


def decide(covariance, platform):
    prior = GaussianPrior(151.5, 148.5, np.array(covariance, dtype=float))
    problem = Problem((SQUARE,), SIGMA, 5.0, 10.0, LinearMotion(5.0), prior=prior)
    decision = ellipse(problem, prior_belief(problem), platform)
    return decision.x - 151.5, decision.y - 148.5


def test_it_measures_across_the_long_axis():
    dx, dy = decide(np.diag([100.0, 1600.0]), (150.0, 0.0))
    assert abs(dy) < 0.02 * abs(dx)
    assert abs(dx) / 10.0 == pytest.approx(6.5, abs=0.5)


def test_it_takes_the_platforms_side():
    assert decide(np.diag([100.0, 1600.0]), (0.0, 100.0))[0] < 0
    assert decide(np.diag([100.0, 1600.0]), (300.0, 100.0))[0] > 0


def test_it_turns_with_the_ellipse():
    turned = np.array([[850.0, 750.0], [750.0, 850.0]])
    dx, dy = decide(turned, (0.0, 300.0))
    assert np.arctan2(dy, dx) == pytest.approx(np.deg2rad(135.0), abs=0.02)


def test_the_table_has_the_thesis_check_values_at_four_degrees():
    ratios, distances = table(SIGMA)
    assert np.interp([1.0, 4.0, 10.0], ratios, distances) == pytest.approx([2.2, 6.7, 12.0], abs=0.35)


def test_the_table_grows_with_the_ratio_and_falls_with_the_noise():
    stored = json.loads(TABLE.read_text())
    rows = np.array(list(stored["distances"].values()))
    assert rows.shape == (len(SIGMAS_DEG), len(RATIOS))
    assert (np.diff(rows, axis=1) > 0).all()
    assert (np.diff(rows, axis=0) < 0).all()


def test_between_tabulated_noises_the_table_is_linear():
    _, low = table(np.deg2rad(4.0))
    _, middle = table(np.deg2rad(5.5))
    _, high = table(np.deg2rad(7.0))
    assert middle == pytest.approx(0.5 * (low + high))


@pytest.mark.long
def test_the_script_computes_the_shipped_table():
    stored, computed = json.loads(TABLE.read_text()), compute()
    assert computed["ratios"] == stored["ratios"]
    for sigma, distances in stored["distances"].items():
        assert computed["distances"][sigma] == pytest.approx(distances, abs=1e-3)


def test_the_tables_optimum_beats_its_neighbourhood():
    ratios, distances = table(np.deg2rad(10.0))
    r = float(np.interp(2.0, ratios, distances))
    best = expected_rmse_after(r, 2.0, np.deg2rad(10.0))
    assert best < expected_rmse_after(0.6 * r, 2.0, np.deg2rad(10.0))
    assert best < expected_rmse_after(1.8 * r, 2.0, np.deg2rad(10.0))
