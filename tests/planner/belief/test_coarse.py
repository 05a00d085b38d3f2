"""Fewer and larger cells for rollouts."""

import numpy as np
import pytest

from planner.belief.coarse import coarser
from planner.belief.estimate import estimate
from planner.belief.grid import fold
from planner.belief.joint import joint_prior, update_joint
from planner.study.scenarios import scenario
from planner.types import Bearing

PROBLEM = scenario("field").problem
BEARINGS = [Bearing(0.0, 0.0, 0.7, 0.1), Bearing(200.0, 0.0, 2.2, 0.1)]


@pytest.mark.parametrize("most", [1, 7, 33, 64])
def test_mass_and_mean_stay_and_no_more_cells_are_left(most):
    belief = fold(PROBLEM, BEARINGS)
    coarse = coarser(belief, most)
    assert max(coarse.nx, coarse.ny) <= most
    assert coarse.density.sum() == pytest.approx(1.0, abs=1e-12)
    fine, same = estimate(belief, "expected_value"), estimate(coarse, "expected_value")
    assert np.hypot(fine.x - same.x, fine.y - same.y) <= 0.51 * coarse.h
    assert (coarse.x0, coarse.y0) == (belief.x0, belief.y0)


def test_every_block_has_the_mass_of_its_cells():
    belief = fold(PROBLEM, BEARINGS)
    coarse = coarser(belief, 20)
    k = round(coarse.h / belief.h)
    assert coarse.density[2, 3] == pytest.approx(belief.density[2 * k : 3 * k, 3 * k : 4 * k].sum(), abs=1e-15)


def test_a_small_grid_is_left_as_it_is():
    belief = fold(PROBLEM, BEARINGS)
    assert coarser(belief, max(belief.nx, belief.ny)) is belief


def test_of_a_joint_belief_the_places_are_kept():
    belief = update_joint(joint_prior(PROBLEM), BEARINGS[0])
    coarse = coarser(belief, 40)
    assert coarse.bearings == belief.bearings == 1
    assert coarse.density.sum() == pytest.approx(1.0, abs=1e-12)
