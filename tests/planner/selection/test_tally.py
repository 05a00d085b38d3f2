import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refusing

from planner.reasons import UnusableNumber
from planner.selection.tally import Tally, check_budget, spread_evenly


@given(st.lists(st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=20), min_size=1, max_size=5), st.floats(-1e6, 1e6))
def test_agrees_with_numpy_whatever_the_offset(batches, offset):
    tally = Tally(2)
    for batch in batches:
        tally.add(np.array([1]), np.array([batch]) + offset)
    every = np.concatenate(batches) + offset
    assert tally.counts.tolist() == [0, len(every)]
    assert tally.means()[1] == pytest.approx(every.mean(), abs=1e-6)
    assert np.isnan(tally.means()[0])
    if len(every) > 1:
        expected = every.std(ddof=1) / np.sqrt(len(every))
        assert tally.std_errors()[1] == pytest.approx(expected, rel=1e-3, abs=1e-2)


def test_an_infinite_cost_loses_without_a_spread():
    tally = Tally(2)
    tally.add(np.array([0, 1]), np.array([[1.0, 2.0], [np.inf, 3.0]]))
    assert np.isinf(tally.means()[1])
    assert np.isnan(tally.std_errors()[1])
    assert tally.std_errors()[0] == pytest.approx(0.5)


@pytest.mark.parametrize("costs", [np.zeros((3, 1)), np.zeros(2), np.array([[1.0], [np.nan]])])
def test_refuses_what_is_no_sample(costs):
    with pytest.raises(ValueError):
        Tally(2).add(np.array([0, 1]), costs)


@given(st.integers(1, 500), st.data())
def test_spread_is_even(n, data):
    kept = data.draw(st.integers(1, n))
    chosen = spread_evenly(n, kept)
    assert len(chosen) == kept
    assert chosen.min() >= 0
    assert chosen.max() < n
    assert np.ptp(np.diff(chosen)) <= 1 if kept > 1 else True


def test_budgets():
    check_budget(1, 1)
    with refusing(UnusableNumber("actions", "at_least_one", "0")):
        check_budget(0, 5)
    with refusing(UnusableNumber("budget", "at_least_one", "0")):
        check_budget(5, 0)
