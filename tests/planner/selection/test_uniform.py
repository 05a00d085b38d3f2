import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refusing

from planner.reasons import UnusableNumber
from planner.selection.uniform import uniform


def table_sampler(costs, calls=None):
    def sample(actions, path_from, path_to):
        if calls is not None:
            calls.append(len(actions) * (path_to - path_from))
        return costs[actions, path_from:path_to]

    return sample


@given(st.integers(1, 30), st.integers(1, 20), st.integers(0, 10_000))
def test_picks_the_least_mean_of_equal_shares(n_actions, paths, seed):
    rng = np.random.default_rng(seed)
    costs = rng.exponential(size=(n_actions, paths))
    result = uniform(table_sampler(costs), n_actions, n_actions * paths, rng)
    assert result.best == np.argmin(costs.mean(axis=1))
    np.testing.assert_allclose(result.means, costs.mean(axis=1))
    assert (result.counts == paths).all()
    assert (result.dropped_in_round == 0).all()


@given(st.integers(1, 30), st.integers(1, 20), st.integers(1, 5), st.integers(0, 10_000))
def test_pruning_never_changes_the_choice(n_actions, paths, stride, seed):
    rng = np.random.default_rng(seed)
    least = rng.uniform(0, 5, n_actions)
    costs = least[:, None] + rng.exponential(size=(n_actions, paths))
    plain = uniform(table_sampler(costs), n_actions, n_actions * paths, rng)
    pruned = uniform(table_sampler(costs), n_actions, n_actions * paths, rng, least=least, stride=stride)
    assert pruned.best == plain.best
    assert pruned.means[pruned.best] == plain.means[plain.best]
    assert (pruned.counts <= plain.counts).all()
    given_up = pruned.counts < paths
    assert (pruned.dropped_in_round == given_up).all()
    assert (pruned.means[given_up] > pruned.means[pruned.best]).all()


def test_ties_up_to_rounding_are_not_given_up():
    least = np.array([0.7, 0.1])
    costs = np.array([[0.7, 0.7, 0.7], [0.1, 0.1, 1.9]])  # equal sums, in floating point the second is the larger
    plain = uniform(table_sampler(costs), 2, 6, np.random.default_rng(0))
    pruned = uniform(table_sampler(costs), 2, 6, np.random.default_rng(0), least=least)
    assert pruned.counts.tolist() == [3, 3]
    assert pruned.best == plain.best


def test_pruning_spares_hopeless_actions():
    calls: list[int] = []
    costs = np.array([[1.0] * 10, [100.0] * 10, [1.5] * 10])
    result = uniform(table_sampler(costs, calls), 3, 30, np.random.default_rng(0), least=np.zeros(3))
    assert result.counts.tolist() == [10, 1, 7]
    assert sum(calls) == result.counts.sum()


def test_small_budget_spreads_over_the_actions():
    result = uniform(table_sampler(np.arange(10.0)[:, None]), 10, 3, np.random.default_rng(0))
    assert np.flatnonzero(result.counts).tolist() == [1, 5, 8]
    assert result.best == 1
    assert np.isnan(result.means[0])


@pytest.mark.parametrize(("n_actions", "budget", "quantity"), [(0, 10, "actions"), (3, 0, "budget"), (3, -1, "budget")])
def test_refuses_nothing_to_choose_or_spend(n_actions, budget, quantity):
    with refusing(UnusableNumber(quantity, "at_least_one", str(min(n_actions, budget)))):
        uniform(table_sampler(np.zeros((3, 10))), n_actions, budget, np.random.default_rng(0))


def test_refuses_nan_costs():
    with pytest.raises(ValueError, match="NaN"):
        uniform(table_sampler(np.full((2, 2), np.nan)), 2, 4, np.random.default_rng(0))
