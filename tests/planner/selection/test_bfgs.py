import numpy as np
from refusals import refusing

from planner.reasons import BudgetTooSmall
from planner.selection.bfgs import bfgs
from planner.selection.continuous import Rectangle

SQUARE = Rectangle(0.0, 0.0, 300.0, 300.0)


def valley(x, y):
    def sample(places, path_from, path_to):
        cost = (places[:, 0] - x) ** 2 + 10 * (places[:, 1] - y) ** 2 + 5.0
        return np.repeat(cost[:, None], path_to - path_from, axis=1)

    return sample


def test_finds_the_bottom_of_a_valley():
    result = bfgs(valley(200, 90), SQUARE, (100, 100), 2000)
    np.testing.assert_allclose(result.places[result.best], (200, 90), atol=0.1)


def test_keeps_to_the_budget_and_the_rectangle():
    result = bfgs(valley(400, 90), SQUARE, (100, 100), 123)
    assert result.counts.sum() <= 123
    assert result.places.min() >= 0
    assert result.places.max() <= 300
    assert result.means[result.best] == result.means.min()


def test_always_looks_at_the_same_paths():
    asked = set()

    def sample(places, path_from, path_to):
        asked.add((path_from, path_to))
        return np.repeat(places.sum(axis=1)[:, None], path_to - path_from, axis=1)

    bfgs(sample, SQUARE, (100, 100), 400, paths=4)
    assert asked == {(0, 4)}


def test_refuses_less_than_a_gradient():
    with refusing(BudgetTooSmall(rollouts=39, needed_rollouts=40)):
        bfgs(valley(1, 1), SQUARE, (10, 20), 39)
