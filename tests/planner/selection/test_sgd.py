import numpy as np
import pytest
from refusals import refusing

from planner.reasons import BudgetTooSmall
from planner.selection.continuous import Rectangle
from planner.selection.sgd import sgd, step_length

SQUARE = Rectangle(0.0, 0.0, 300.0, 300.0)


def noisy_bowl(x, y, rng):
    """Common random numbers: the noise of path j is the same at every place."""
    noise = rng.normal(0, 5, 100_000)

    def sample(places, path_from, path_to):
        return np.hypot(places[:, 0] - x, places[:, 1] - y)[:, None] + noise[None, path_from:path_to]

    return sample


def test_steps_shrink_from_20_m_by_exp_4():
    steps = [step_length(i, 30) for i in range(1, 31)]
    assert steps[0] == 20.0
    assert steps[-1] == pytest.approx(20.0 * np.exp(-4))
    np.testing.assert_allclose(np.diff(np.log(steps)), -4 / 29)


def test_walks_downhill_to_the_bottom():
    result = sgd(noisy_bowl(200, 90, np.random.default_rng(3)), SQUARE, (100, 100), 8 * (4 * 40 + 1))
    assert np.hypot(*(result.places[result.best] - (200, 90))) < 3.0


def test_stays_in_the_rectangle_and_the_budget():
    result = sgd(noisy_bowl(400, 150, np.random.default_rng(3)), SQUARE, (290, 150), 1000)
    assert result.places.min() >= 0
    assert result.places.max() <= 300
    assert result.counts.sum() <= 1000
    assert result.places[result.best][0] == 300.0


def test_stays_put_where_nothing_slopes():
    result = sgd(lambda p, i, j: np.ones((len(p), j - i)), SQUARE, (10, 20), 1000)
    assert result.places[result.best].tolist() == [10.0, 20.0]


def test_refuses_less_than_a_step():
    with refusing(BudgetTooSmall(rollouts=39, needed_rollouts=40)):
        sgd(lambda p, i, j: np.ones((len(p), j - i)), SQUARE, (10, 20), 39)
