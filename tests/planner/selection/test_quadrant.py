import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refusing

from planner.reasons import BudgetTooSmall
from planner.selection.continuous import Rectangle
from planner.selection.quadrant import quadrant_search

SQUARE = Rectangle(0.0, 0.0, 160.0, 160.0)


def bowl(x, y):
    def sample(places, path_from, path_to):
        return np.repeat(np.hypot(places[:, 0] - x, places[:, 1] - y)[:, None], path_to - path_from, axis=1)

    return sample


@given(st.integers(0, 6), st.integers(1, 9))
def test_spends_r_times_9_plus_5_l(levels, paths):
    result = quadrant_search(bowl(40, 90), SQUARE, paths * (9 + 5 * levels), levels=levels)
    assert result.counts.sum() == paths * (9 + 5 * levels)
    assert (result.counts == paths).all()
    assert len(np.unique(result.places, axis=0)) == 9 + 5 * levels


@given(st.floats(0, 160), st.floats(0, 160))
def test_closes_in_on_a_bowl(x, y):
    """Each level halves the lattice: four levels of a 160 m square end at 5 m spacing, a bowl's quadrant is the right
    one or its neighbour."""
    result = quadrant_search(bowl(x, y), SQUARE, 29, levels=4)
    place = result.places[result.best]
    assert np.hypot(place[0] - x, place[1] - y) <= 25.0
    assert result.means[result.best] == result.means.min()


def test_refuses_too_small_a_budget():
    with refusing(BudgetTooSmall(rollouts=28, needed_rollouts=29)):
        quadrant_search(bowl(0, 0), SQUARE, 28, levels=4)


def test_refuses_an_empty_rectangle():
    with pytest.raises(ValueError, match="empty"):
        Rectangle(0.0, 0.0, 0.0, 1.0)
