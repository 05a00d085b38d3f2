import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refusing

from planner.reasons import UnusableNumber
from planner.selection.sequential_halving import sequential_halving


def gaussian_arms(means, sd, rng):
    def sample(actions, path_from, path_to):
        return means[actions, None] + sd * rng.standard_normal((len(actions), path_to - path_from))

    return sample


def test_eight_arms_of_the_thesis():
    """Means 0.1 .. 0.8, sd 0.3, N = 300: 296 samples, best arm in about 9836 of 10000 runs (here of 3000)."""
    rewards = np.arange(1, 9) / 10
    rng = np.random.default_rng(1)
    sample = gaussian_arms(-rewards, 0.3, rng)
    results = [sequential_halving(sample, 8, 300, rng) for _ in range(3000)]
    assert {int(r.counts.sum()) for r in results} == {296}
    hits = np.mean([r.best == 7 for r in results])
    assert hits == pytest.approx(0.9836, abs=4 * np.sqrt(0.9836 * 0.0164 / 3000))


@pytest.mark.parametrize(
    ("actions", "budget", "used"),
    [(100, 700, 689), (100, 1400, 1391), (100, 2100, 2093), (400, 3600, 3589), (400, 7200, 7191), (400, 10800, 10793)],
)
def test_rollouts_used(actions, budget, used):
    rng = np.random.default_rng(0)
    result = sequential_halving(gaussian_arms(np.zeros(actions), 1.0, rng), actions, budget, rng)
    assert result.counts.sum() == used


@given(st.integers(1, 200), st.integers(1, 3000), st.integers(0, 1000))
def test_halves_within_the_budget(n_actions, budget, seed):
    rng = np.random.default_rng(seed)
    result = sequential_halving(gaussian_arms(rng.uniform(size=n_actions), 0.1, rng), n_actions, budget, rng)
    assert 1 <= result.counts.sum() <= budget
    assert np.flatnonzero(result.dropped_in_round == 0).tolist() == [result.best]
    for number in range(1, result.dropped_in_round.max() + 1):
        dropped = (result.dropped_in_round == number) & (result.counts > 0)
        later = (result.dropped_in_round > number) | (result.dropped_in_round == 0)
        assert dropped.sum() == (later.sum() + dropped.sum()) // 2
        if number > 1:
            assert result.counts[dropped].min() > result.counts[result.dropped_in_round == number - 1].max()


def test_paths_continue_where_the_round_before_stopped():
    asked: list[tuple[int, int]] = []

    def sample(actions, path_from, path_to):
        asked.append((path_from, path_to))
        return np.repeat(actions[:, None].astype(float), path_to - path_from, axis=1)

    result = sequential_halving(sample, 8, 300, np.random.default_rng(0))
    assert asked == [(0, 12), (12, 37), (37, 87)]
    assert result.best == 0
    assert result.dropped_in_round.tolist() == [0, 3, 2, 2, 1, 1, 1, 1]
    np.testing.assert_allclose(result.means, np.arange(8))


def test_one_action_is_valued_all_the_same():
    result = sequential_halving(lambda a, i, j: np.full((1, j - i), 3.0), 1, 50, np.random.default_rng(0))
    assert (result.best, result.counts[0], result.means[0]) == (0, 50, 3.0)


def test_budget_too_small_for_all_actions_spreads():
    result = sequential_halving(
        lambda a, i, j: np.repeat(a[:, None].astype(float), j - i, axis=1), 400, 400, np.random.default_rng(0)
    )
    assert (result.counts > 0).sum() == 64
    assert result.best == np.flatnonzero(result.counts)[0]


@pytest.mark.parametrize(("n_actions", "budget"), [(0, 10), (5, 0)])
def test_refuses_nothing_to_choose_or_spend(n_actions, budget):
    with refusing(UnusableNumber):
        sequential_halving(lambda a, i, j: np.zeros((len(a), j - i)), n_actions, budget, np.random.default_rng(0))
