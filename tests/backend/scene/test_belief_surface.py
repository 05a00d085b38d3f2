"""The belief as a landscape: high where it is probable, on the ground where it is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from narrowing import known

from backend.scene.belief_surface import (
    FOOT_Z,
    HIGHEST,
    belief_surface,
    coarsened,
    height_at,
    peak_height_m,
)
from planner.belief.grid import GridBelief

SQUARE = np.array([(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)])


def belief(density: np.ndarray, h: float = 10.0) -> GridBelief:
    shape = (SQUARE,)
    return GridBelief(density / density.sum(), 0.0, 0.0, h, shape, shape, bearings=1, flat_prior=True)


def hill(n: int = 10, spread: float = 20.0) -> GridBelief:
    h = 100.0 / n
    x, y = np.meshgrid((np.arange(n) + 0.5) * h, (np.arange(n) + 0.5) * h)
    return belief(np.exp(-((x - 65) ** 2 + (y - 35) ** 2) / (2 * spread**2)), h)


def test_the_summit_stands_over_the_most_probable_cell() -> None:
    surface = known(belief_surface(hill(), 50.0))
    top = surface.vertices[surface.vertices[:, 2].argmax()]
    assert top == pytest.approx((65.0, 35.0, 50.0 + FOOT_Z))
    assert surface.vertices[:, 2].min() == pytest.approx(FOOT_Z)


def test_height_is_proportional_to_probability() -> None:
    uneven = belief(np.array([[1.0, 2.0], [4.0, 0.0]]), 50.0)
    surface = known(belief_surface(uneven, 40.0))
    heights = {(x, y): z - FOOT_Z for x, y, z in surface.vertices.tolist()}
    assert heights[(25.0, 25.0)] == pytest.approx(10.0)
    assert heights[(75.0, 25.0)] == pytest.approx(20.0)
    assert heights[(25.0, 75.0)] == pytest.approx(40.0)
    assert height_at(uneven, 30.0, 60.0, 40.0) == pytest.approx(FOOT_Z + 40.0)
    assert height_at(uneven, -1.0, 60.0, 40.0) == FOOT_Z


def test_it_fades_to_nothing_where_nothing_is() -> None:
    surface = known(belief_surface(hill(50, 4.0), 50.0))
    assert len(surface.vertices) < 50 * 50 / 4
    alpha, height = surface.colours[:, 3], surface.vertices[:, 2] - FOOT_Z
    assert alpha[height < 0.1].max() < 30
    assert alpha[height > 20].min() > 200


def test_every_face_refers_to_a_vertex_and_every_vertex_is_used() -> None:
    surface = known(belief_surface(hill(), 10.0))
    assert set(np.unique(surface.faces)) == set(range(len(surface.vertices)))


def test_more_information_makes_a_higher_peak_up_to_a_limit() -> None:
    flat = belief(np.ones((10, 10)))
    heights = [peak_height_m(each, 100.0) for each in (flat, hill(40, 20), hill(40, 10), hill(40, 5), hill(100, 0.5))]
    assert heights == sorted(heights)
    assert heights[0] == pytest.approx(3.0)
    assert heights[-1] == pytest.approx(100 * HIGHEST)


def test_the_same_belief_on_a_finer_grid_has_the_same_peak() -> None:
    coarse = hill(10)
    fine = replace(coarse, density=np.kron(coarse.density, np.ones((2, 2))) / 4, h=coarse.h / 2)
    assert peak_height_m(fine, 100.0) == pytest.approx(peak_height_m(coarse, 100.0))


@given(st.integers(1, 400), st.integers(1, 400))
def test_large_grids_are_averaged_down(ny: int, nx: int) -> None:
    density = np.arange(1.0, ny * nx + 1).reshape(ny, nx)
    smaller, block = coarsened(density)
    assert max(smaller.shape) <= 128
    assert smaller.sum() * block**2 == pytest.approx(density.sum())
