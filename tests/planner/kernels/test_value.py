"""The dynamic program's compiled kernels compute what the readable ones say."""

import numpy as np
import pytest

from planner.kernels.value import reference
from planner.kernels.value.iteration import iterate
from planner.kernels.value.model import Transitions, nodes, ratios, scales
from planner.kernels.value.transitions import transitions
from planner.policy.value_table import normal_draws


def some_transitions(rho, places, sigma, draws):
    out = Transitions(*(np.zeros((len(rho), len(places), len(places), len(draws))) for _ in Transitions._fields))
    transitions(rho, places, sigma, draws, out)
    return out


@pytest.mark.parametrize("sigma_deg", [2.0, 7.0])
def test_a_bearing_leaves_the_shape_of_the_exact_posterior(sigma_deg):
    rho, places, draws = np.array([1.3, 4.0]), np.array([0.03, 0.7, 3.1]), normal_draws(5)
    sigma = float(np.deg2rad(sigma_deg))
    out = some_transitions(rho, places, sigma, draws)
    for r, i, j, k in np.ndindex(out.shrunk.shape):
        wanted = reference.posterior(float(rho[r]), np.array([places[i], places[j]]), sigma, draws[k])
        assert [field[r, i, j, k] for field in out] == pytest.approx(wanted, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("standoff", [0.0, 40.0])
def test_value_iteration_is_the_readable_one(standoff):
    rho, places, sizes = ratios()[:3], nodes()[:5], scales()[::1][:9]
    rng = np.random.default_rng(1)
    shape = (3, 5, 5, 4)
    t = Transitions(
        np.log(rng.uniform(0.2, 1.0, shape)), rng.uniform(0.0, 1.0, shape), rng.uniform(0.0, 4.0, shape),
        rng.uniform(0.0, 4.0, shape), rng.uniform(0.2, 1.5, shape),
    )  # fmt: skip
    after, value, _ = iterate(t, sizes, rho, places, 5.0, 10.0, False, 5.0, 0.0, 1.0, standoff, 3, 0.0)
    ours, ours_after = np.zeros_like(value), np.zeros_like(after)
    for _ in range(3):
        ours_after, ours = reference.sweep(ours, t, sizes, rho, places, 5.0, 10.0, 5.0, standoff)
    # a ratio at the grid's end counts as a millionth of a step before it
    assert after == pytest.approx(ours_after, rel=1e-6)
    assert value == pytest.approx(ours, rel=1e-6)
    assert (value >= 10.0).all()


def test_movement_time_models_reach_the_program():
    rho, places, sizes = ratios()[:2], nodes()[:2], scales()[:2]
    t = Transitions(*(np.full((2, 2, 2, 1), v) for v in (-3.0, 0.0, 0.0, 0.0, 0.01)))
    quick = iterate(t, sizes, rho, places, 5.0, 10.0, False, 5.0, 0.0, 1.0, 0.0, 2, 0.0)[1]
    ramped = iterate(t, sizes, rho, places, 5.0, 10.0, True, 5.0, 6.0, 1.0, 0.0, 2, 0.0)[1]
    assert quick.min() == pytest.approx(10.0)
    assert ramped.min() == pytest.approx(16.0)
