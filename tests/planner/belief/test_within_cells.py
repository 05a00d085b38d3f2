"""Cells weighed in parts where bearings cross within them, against every part of every cell weighed."""

import math

import numpy as np
import pytest

from planner.belief.blocks import weighed_in_blocks
from planner.belief.sharp import Crossings, crossings
from planner.belief.within_cells import in_parts
from planner.types import Bearing, FloatArray

CELLS, SIDE = 60, 16
OUTLIERS = 0.05


def log_of(bearings: list[Bearing], x: FloatArray, y: FloatArray) -> FloatArray:
    """Of bearings that share no error, an even share of outliers, each in units of its peak."""
    log = np.zeros(len(x))
    for b in bearings:
        off = np.arctan2(y - b.y, x - b.x) - b.angle
        off = np.arctan2(np.sin(off), np.cos(off))
        honest = (1.0 - OUTLIERS) * np.exp(-0.5 * (off / b.sigma) ** 2)
        log += np.log(honest + OUTLIERS * b.sigma / np.sqrt(2.0 * np.pi))
    return log


def around(target: tuple[float, float], away: float, sigma: float, count: int = 5) -> list[Bearing]:
    """Each of a source of its own: those of one from places so near count as one."""
    rng = np.random.default_rng(count)
    turns = [1.3 * k + 0.2 for k in range(count)]
    return [
        Bearing(
            target[0] + away * math.cos(turn),
            target[1] + away * math.sin(turn),
            turn + math.pi + rng.normal(0.0, sigma),
            sigma,
            source=f"source {k}",
        )
        for k, turn in enumerate(turns)
    ]


def prior_with_a_hole() -> FloatArray:
    prior = np.random.default_rng(0).uniform(0.5, 1.0, (CELLS, CELLS))
    prior[:, :7] = 0.0
    return prior / prior.sum()


@pytest.mark.parametrize(("away", "sigma"), [(6.0, math.radians(3.0)), (2.0, math.radians(6.0))])
@pytest.mark.parametrize("few", [3000, 200])
def test_a_cell_has_the_mean_likelihood_of_what_lies_in_it(away: float, sigma: float, few: int) -> None:
    """Cells of 1 m, 16 x 16 parts of each weighed: the centres alone are off by a tenth of all mass or more."""
    prior, bearings = prior_with_a_hole(), around((31.37, 24.81), away, sigma)
    found = weighed_in_blocks(prior, 0.0, 0.0, 1.0, lambda x, y: log_of(bearings, x, y), few, crossings(bearings))
    fine = prior.repeat(SIDE, axis=0).repeat(SIDE, axis=1)
    y, x = (np.indices(fine.shape) + 0.5) / SIDE
    fine = fine * np.exp(log_of(bearings, x.ravel(), y.ravel())).reshape(fine.shape)
    exact = fine.reshape(CELLS, SIDE, CELLS, SIDE).sum(axis=(1, 3)) / fine.sum()
    assert found.parts is not None
    assert 0.5 * np.abs(found.density - exact).sum() < 0.05
    assert found.mass.sum() == pytest.approx(1.0) == found.density.sum()
    fine /= fine.sum()
    assert float(found.mass @ found.x) == pytest.approx(float((fine * x).sum()), abs=0.1)
    assert not found.density[prior == 0.0].any()
    centres = weighed_in_blocks(prior, 0.0, 0.0, 1.0, lambda x, y: log_of(bearings, x, y), few)
    assert 0.5 * np.abs(centres.density - exact).sum() > 0.1


def test_where_crossings_tell_nothing_cells_stay_whole() -> None:
    prior = prior_with_a_hole()
    nothing = Crossings(np.empty(0), np.empty(0), np.empty(0), 0)
    wide = crossings(around((31.0, 25.0), 25.0, 0.1))
    excluded = Crossings(np.array([30.2]), np.array([20.1]), np.array([0.01]), 2)

    def far(x: FloatArray, y: FloatArray) -> FloatArray:
        return -1e3 * np.exp(-((x - 30.2) ** 2) - (y - 20.1) ** 2)

    for sharp in (nothing, wide, excluded):
        assert in_parts(prior, np.zeros(prior.shape), 0.0, 0.0, 1.0, far, sharp) is None


def test_a_crossing_at_the_far_edge_lies_in_the_last_cell() -> None:
    """South of the edge, but by less than its distance from the corner can tell."""
    prior = np.full((100, 100), 1e-4)
    at = np.array([np.nextafter(3000.0, 0.0)])
    found = in_parts(
        prior,
        np.zeros(prior.shape),
        -3000.0,
        -3000.0,
        60.0,
        lambda x, _: np.full(len(x), 9.0),
        Crossings(at, at, at / 600.0, 2),
    )
    assert found is not None
    assert found.rows.max() == found.columns.max() == 99


def test_parts_of_a_prior_of_which_every_block_was_split() -> None:
    """As legs leave it, which weigh no cells that hold next to nothing."""
    prior = np.zeros((CELLS, CELLS))
    prior[22:28, 28:34] = 1.0 / 36.0
    bearings = around((31.37, 24.81), 2.0, math.radians(6.0))
    found = weighed_in_blocks(prior, 0.0, 0.0, 1.0, lambda x, y: log_of(bearings, x, y), 200, crossings(bearings))
    assert found.parts is not None
    assert found.mass.sum() == pytest.approx(1.0) == found.density.sum()
