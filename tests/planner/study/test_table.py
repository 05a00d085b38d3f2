import math

import numpy as np
import pandas as pd
import pytest

from planner.study.cell import Cell
from planner.study.reference import printed
from planner.study.table import half_width, markdown, row, summarize


def missions(times):
    n = len(times)
    return pd.DataFrame(
        {
            "time": times,
            "bearings": np.full(n, 2),
            "travel": np.full(n, 100.0),
            "localized": np.full(n, True),
            "in_c95": np.full(n, True),
            "error": np.full(n, 3.0),
        }
    )


def test_interval_covers_the_mean_in_95_of_100_samples():
    rng = np.random.default_rng(0)
    samples = rng.exponential(10.0, (2000, 200))
    inside = [abs(s.mean() - 10.0) <= half_width(s) for s in samples]
    assert np.mean(inside) == pytest.approx(0.95, abs=0.02)


def test_half_width_by_hand():
    # 1, 2, 3, 4: variance with n - 1 is 5/3; 1.959964 sqrt(5/3) / sqrt(4) = 1.265151
    assert half_width(np.array([1.0, 2.0, 3.0, 4.0])) == pytest.approx(1.265151, abs=1e-6)
    assert half_width(np.full(10, 7.0)) == 0.0


def test_the_joint_interval_adds_both_half_widths_in_quadrature():
    cell = Cell(planner="base")  # the thesis: 74.31 +- 0.54
    spread = np.tile([-10.0, 10.0], 200)
    joint = math.hypot(half_width(spread), 0.54)
    for side in (-1.0, 1.0):
        assert summarize(cell, missions(74.31 + side * 0.999 * joint + spread)).within is True
        assert summarize(cell, missions(74.31 + side * 1.001 * joint + spread)).within is False


def test_within_means_inside_the_joint_interval():
    cell = Cell(planner="base")
    spread = np.tile([-10.0, 10.0], 200)  # half width 0.98
    assert summarize(cell, missions(74.31 + 1.0 + spread)).within is True
    assert summarize(cell, missions(74.31 + 1.3 + spread)).within is False
    assert summarize(Cell(planner="vander_hook"), missions(spread)).within is None


def test_one_run_has_no_interval():
    summary = summarize(Cell(planner="base"), missions([70.0]))
    assert math.isnan(summary.ci95_s)
    assert summary.json()["ci95_s"] is None
    assert summary.within is None


def test_rows_and_markdown():
    summary = summarize(Cell(planner="base"), missions(80.0 + np.tile([-1.0, 1.0], 100)))
    assert row(summary)[3:6] == ("80.00 ± 0.14", "74.31 ± 0.54", "+5.69 *")
    assert markdown([summary]).count("\n") == 2


@pytest.mark.parametrize(
    ("cell", "mean"),
    [
        (Cell(planner="base", config="fast"), 55.03),
        (Cell(planner="sopt", config="slow"), 392.01),
        (Cell(planner="rollout", selection="uniform", sampling="deterministic", budget=3200), 58.22),
        (Cell(planner="rollout", budget=7200), 57.3),
        (Cell(scenario="3", planner="entpp"), 98.22),
        (Cell(planner="rollout", budget=700, actions="10x10"), None),
        (Cell(planner="base", measurement_time=5.0), None),
        (Cell(scenario="1", planner="base"), None),
        (Cell(planner="base", estimator="expected_value"), None),
    ],
)
def test_the_thesis_figure_of_a_cell(cell, mean):
    found = printed(cell.fields())
    assert (found and found.mean) == mean
