"""Places weighed on blocks of cells, against every cell weighed."""

from collections.abc import Callable

import numpy as np
import pytest

from planner.belief import blocks
from planner.belief.blocks import Places, weighed_in_blocks
from planner.types import FloatArray

SIZE = (90, 131)  # no multiple of a block's side


def ridges(x: FloatArray, y: FloatArray, count: int = 3, sigma: float = 0.1, outliers: float = 0.03) -> FloatArray:
    """The logarithm of `count` bearings' likelihood, rad, from around a target at (80, 40)."""
    log = np.zeros(len(x))
    for k in range(count):
        at_x, at_y = 60.0 + 55.0 * np.cos(2.0 * k), 45.0 + 40.0 * np.sin(2.0 * k)
        error = np.arctan2(y - at_y, x - at_x) - np.arctan2(40.0 - at_y, 80.0 - at_x)
        error = np.arctan2(np.sin(error), np.cos(error))
        log += np.log((1.0 - outliers) * np.exp(-0.5 * (error / sigma) ** 2) + outliers)
    return log


def weighed(
    prior: FloatArray, log: Callable[..., FloatArray], few: int = blocks.FEW_CELLS, **given: float
) -> tuple[Places, int]:
    """The places, and how many blocks were weighed."""
    asked = 0

    def weigh(x: FloatArray, y: FloatArray) -> FloatArray:
        nonlocal asked
        asked += len(x)
        return log(x, y, **given)

    return weighed_in_blocks(prior, 0.0, 0.0, 1.0, weigh, few), asked


def whole(prior: FloatArray, log: Callable[..., FloatArray], **given: float) -> FloatArray:
    rows, columns = np.indices(prior.shape)
    density = prior * np.exp(log(columns.ravel() + 0.5, rows.ravel() + 0.5, **given)).reshape(prior.shape)
    return density / density.sum()


def bumpy(seed: int) -> FloatArray:
    """A prior with holes, uneven within the blocks."""
    rng = np.random.default_rng(seed)
    prior = rng.uniform(0.2, 1.0, SIZE)
    prior[30:47, 10:33] = 0.0
    return prior / prior.sum()


@pytest.mark.parametrize("sigma", [0.06, 0.1, 0.3])
@pytest.mark.parametrize("count", [1, 2, 3, 6])
@pytest.mark.parametrize("outliers", [1e-4, 0.05, 0.3])
def test_the_mass_of_the_cells_is_nearly_that_of_all_weighed(sigma: float, count: int, outliers: float) -> None:
    prior = bumpy(count)
    given = {"count": count, "sigma": sigma, "outliers": outliers}
    found, _ = weighed(prior, ridges, **given)
    assert 0.5 * np.abs(found.density - whole(prior, ridges, **given)).sum() < 2e-3
    assert found.density.sum() == pytest.approx(1.0, abs=1e-12)
    assert found.mass.sum() == pytest.approx(1.0, abs=1e-12)
    assert not found.density[prior == 0.0].any()


def test_where_the_belief_is_even_few_blocks_are_weighed() -> None:
    _, asked = weighed(bumpy(0), ridges, count=4)
    assert asked < 0.4 * np.prod(SIZE)


def test_the_mass_belongs_to_the_blocks_that_are_left() -> None:
    found, asked = weighed(bumpy(1), ridges)
    assert len(found.x) == len(found.y) == len(found.mass) < asked
    rows, columns = np.indices(SIZE) + 0.5
    mean = found.mass @ np.stack([found.x, found.y], axis=1)
    assert mean == pytest.approx([(found.density * columns).sum(), (found.density * rows).sum()], abs=0.05)


def test_few_cells_are_all_weighed() -> None:
    prior = bumpy(2)[:40, :60]
    found, asked = weighed(prior, ridges)
    assert asked == np.count_nonzero(prior) <= blocks.FEW_CELLS
    assert found.density == pytest.approx(whole(prior, ridges), abs=1e-15)


@pytest.mark.parametrize("count", [1, 3])
def test_of_dear_cells_fewer_are_weighed_for_nearly_the_same(count: int) -> None:
    prior = bumpy(3)
    _, of_cheap = weighed(prior, ridges, count=count)
    found, asked = weighed(prior, ridges, blocks.FEW_DEAR_CELLS, count=count)
    assert asked < 0.9 * of_cheap
    assert 0.5 * np.abs(found.density - whole(prior, ridges, count=count)).sum() < 2e-3


def test_all_of_one_place_is_all_there_is() -> None:
    prior = np.zeros(SIZE)
    prior[61, 77] = 1.0
    found, _ = weighed(prior, ridges)
    assert found.density[61, 77] == 1.0
