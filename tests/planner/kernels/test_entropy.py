import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planner.kernels.entropy import expected_entropies, expected_entropies_reference


def random_belief(rng, n=300):
    mass = rng.exponential(size=n)
    return rng.uniform(0, 300, (n, 2)), mass / mass.sum()


@settings(deadline=None)
@given(st.integers(0, 10_000), st.floats(1.0, 22.0))
def test_compiled_equals_reference(seed, sigma_deg):
    rng = np.random.default_rng(seed)
    cells, mass = random_belief(rng)
    places, aims = rng.uniform(-100, 400, (5, 2)), cells[rng.integers(0, len(cells), 3)]
    arguments = (cells, mass, places, aims, np.deg2rad(sigma_deg))
    np.testing.assert_allclose(expected_entropies(*arguments), expected_entropies_reference(*arguments), rtol=1e-9)


def test_a_bearing_across_a_long_belief_tells_more_than_one_along_it():
    x = np.linspace(0, 300, 301)
    cells = np.stack([x, np.zeros_like(x)], axis=1)
    mass = np.full(len(x), 1 / len(x))
    across, along = expected_entropies(
        cells, mass, np.array([[150.0, -50.0], [-50.0, 0.0]]), np.array([[150.0, 0.0]]), np.deg2rad(4)
    )
    assert across < 3.0
    assert along == pytest.approx(np.log(301))


def test_a_wedge_without_a_cell_is_infinitely_bad():
    cells, mass = np.array([[0.0, 100.0], [10.0, 100.0]]), np.array([0.5, 0.5])
    arguments = (cells, mass, np.zeros((1, 2)), np.array([[100.0, 0.0]]), np.deg2rad(4))
    assert np.isinf(expected_entropies(*arguments)).all()
    assert np.isinf(expected_entropies_reference(*arguments)).all()


def test_wide_sigma_falls_back_to_the_reference():
    cells, mass = random_belief(np.random.default_rng(0))
    arguments = (cells, mass, np.array([[150.0, 150.0]]), np.array([[20.0, 30.0]]), np.deg2rad(40))
    np.testing.assert_array_equal(expected_entropies(*arguments), expected_entropies_reference(*arguments))
