"""The adaptive grid Bayes filter (spec 2, thesis 3.1.2 and 4.3.1): where the emitter may be, as mass a cell.

The grid covers the smallest rectangle around the possible target positions. A bearing multiplies the likelihood at
the cell centres, then the grid is cropped and, when it has become coarse, doubled. A bearing without outlier mixture
is hard: nothing outside its +-4 sigma wedge survives. A mixture (outlier probability, several peaks) only weighs; then
the grid is cropped to the cells that hold relevant mass, so that several hypotheses stay.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from planner.geometry import (
    bounds,
    cells_touching,
    centres,
    clip_convex,
    clip_wedge,
    convex_hull,
    signed_area,
    validate_area,
)
from planner.observation import (
    WEDGE_SIGMAS,
    cuts,
    hard_likelihood,
    mixture_likelihood,
    resolved_likelihood,
    validate_bearing,
)
from planner.options import CellLikelihood
from planner.reasons import PriorOutsideArea, UnusableGaussian, UnusableRing, disagreement
from planner.types import (
    Bearing,
    BoolArray,
    FloatArray,
    GaussianPrior,
    InconsistentBearings,
    PlannerError,
    Problem,
    Region,
    Ring,
    RingPrior,
)

FIRST_CELLS = 100
"""Cells on the longer axis of the first grid."""

COARSE_CELLS = 40
"""A grid with fewer cells on its longer axis is doubled."""

FEWEST_CELLS = 10
"""A likelihood is never evaluated on fewer cells than this on the longer axis: the grid is doubled before."""

FINER = 2
"""So many times as many cells has the first grid of a problem with resolved likelihoods; they are never evaluated on
fewer than FINER COARSE_CELLS."""

MOST_CELLS = 256 * 256
"""A grid that carries several hypotheses is not doubled beyond this many cells."""

NEGLIGIBLE_MASS = 1e-6
"""What a mixture belief may lose when it is cropped."""

_ALIGN = 1e-9
_DEEPEST_DOUBLING = 16


@dataclass(frozen=True, slots=True, eq=False)
class GridBelief:
    """Probability mass of square cells.

    density: (ny, nx), mass a cell, sums to 1, row 0 southernmost, column 0 westernmost. x0, y0: south-west corner of
    the grid, m ENU. h: cell size, m. area: the target area. possible: what the hard wedges left of it. bearings: how
    many have been folded in. flat_prior: the prior knew nothing but an area. copies: side of the square blocks of
    cells that are equal because the grid was doubled after the last bearing (1: none).
    """

    density: FloatArray
    x0: float
    y0: float
    h: float
    area: Region
    possible: Region
    bearings: int
    flat_prior: bool
    copies: int = 1

    @property
    def nx(self) -> int:
        """Columns of cells, west to east."""
        return self.density.shape[1]

    @property
    def ny(self) -> int:
        """Rows of cells, south to north."""
        return self.density.shape[0]

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(x_min, y_min, x_max, y_max) of the grid's outer edge, m ENU."""
        return self.x0, self.y0, self.x0 + self.nx * self.h, self.y0 + self.ny * self.h

    def centres(self) -> tuple[FloatArray, FloatArray]:
        """x (nx,) and y (ny,) of the cell centres, m ENU."""
        return centres(self.x0, self.h, self.nx), centres(self.y0, self.h, self.ny)

    def hull(self) -> Ring:
        """Convex hull of the possible target positions, counter-clockwise."""
        return convex_hull(np.concatenate(self.possible))


def prior_belief(problem: Problem) -> GridBelief:
    """The belief before any bearing. PlannerError when area or prior is unusable."""
    area = validate_area(problem.area)
    prior = problem.prior
    possible = area
    if isinstance(prior, RingPrior):
        possible = _clip_to_disc(area, prior)
    x_min, y_min, x_max, y_max = bounds(possible)
    cells = FINER * FIRST_CELLS if problem.likelihood == "resolved" else FIRST_CELLS
    h = max(x_max - x_min, y_max - y_min) / cells
    nx, ny = (max(1, int(np.ceil(extent / h - _ALIGN))) for extent in (x_max - x_min, y_max - y_min))
    density = cells_touching(area, x_min, y_min, h, nx, ny).astype(float)
    x, y = np.meshgrid(centres(x_min, h, nx), centres(y_min, h, ny))
    if isinstance(prior, GaussianPrior):
        density *= _gaussian(prior, x, y)
    elif isinstance(prior, RingPrior):
        density *= _ring_share(prior, x, y, h)
    mass = density.sum()
    if not mass > 0:
        raise PlannerError(PriorOutsideArea())
    flat = not isinstance(prior, GaussianPrior)
    return GridBelief(density / mass, x_min, y_min, h, area, possible, bearings=0, flat_prior=flat)


def fold(problem: Problem, bearings: Iterable[Bearing]) -> GridBelief:
    """The belief after all bearings, in the order given. Raises InconsistentBearings like `update`."""
    belief = prior_belief(problem)
    for bearing in bearings:
        belief = update(belief, bearing, problem.likelihood)
    return belief


def update(belief: GridBelief, bearing: Bearing, likelihood: CellLikelihood = "centre") -> GridBelief:
    """Bayes' rule for one bearing (3.26-3.28), then crop and double. likelihood: of a hard wedge.

    Raises InconsistentBearings when the bearing's wedge and what earlier ones left have no common point.
    """
    validate_bearing(bearing)
    return _update_hard(belief, bearing, likelihood) if cuts(bearing) else _update_soft(belief, bearing)


def _update_hard(belief: GridBelief, bearing: Bearing, likelihood: CellLikelihood) -> GridBelief:
    half = WEDGE_SIGMAS * bearing.sigma
    clipped = (clip_wedge(ring, bearing.x, bearing.y, bearing.angle, half) for ring in belief.possible)
    possible = tuple(ring for ring in clipped if len(ring) > 0)
    if not possible:
        raise _no_common_point(belief)
    belief = _crop_to(replace(belief, possible=possible), bounds(possible))
    extent = bounds(possible)
    longer = max(extent[2] - extent[0], extent[3] - extent[1])
    doublings = 0
    fewest = FINER * COARSE_CELLS if likelihood == "resolved" else FEWEST_CELLS
    while max(belief.nx, belief.ny) < fewest and longer > 0 and doublings < _DEEPEST_DOUBLING:
        belief = _crop_to(_doubled(belief), extent)
        doublings += 1
    x, y = np.meshgrid(*belief.centres())
    if likelihood == "resolved":
        density = belief.density * resolved_likelihood(bearing, x, y, belief.h)
    else:
        density = belief.density * hard_likelihood(bearing, x, y, margin=belief.h / np.sqrt(2.0))
    mass = density.sum()
    if not mass > 0:
        raise _no_common_point(belief)
    updated = replace(belief, density=density / mass, bearings=belief.bearings + 1, copies=1)
    return _doubled(updated) if max(updated.nx, updated.ny) < COARSE_CELLS else updated


def _update_soft(belief: GridBelief, bearing: Bearing) -> GridBelief:
    x, y = np.meshgrid(*belief.centres())
    density = belief.density * mixture_likelihood(bearing, x, y)
    mass = density.sum()
    if not mass > 0:
        raise _no_common_point(belief)
    belief = replace(belief, density=density / mass, bearings=belief.bearings + 1, copies=1)
    belief = _crop_to(belief, extent_of(belief, smallest_set(belief, 1.0 - NEGLIGIBLE_MASS)))
    belief = replace(belief, density=belief.density / belief.density.sum())
    x_min, y_min, x_max, y_max = extent_of(belief, smallest_set(belief, 0.95))
    coarse = max(x_max - x_min, y_max - y_min) < (COARSE_CELLS - 0.5) * belief.h
    return _doubled(belief) if coarse and 4 * belief.density.size <= MOST_CELLS else belief


def smallest_set(belief: GridBelief, share: float) -> BoolArray:
    """(ny, nx) bool: the fewest cells that hold `share` of the mass; ties go to the first cell in row order."""
    flat = belief.density.ravel()
    falling = np.sort(flat)[::-1]
    cumulative: FloatArray = np.cumsum(falling)
    count = int(np.searchsorted(cumulative, share * float(cumulative[-1]))) + 1
    least = falling[count - 1]
    chosen = flat > least
    chosen[np.flatnonzero(flat == least)[: count - int(np.count_nonzero(chosen))]] = True
    return chosen.reshape(belief.density.shape)


def digest(belief: GridBelief) -> str:
    """SHA-256 of the grid's geometry and masses, bit for bit."""
    geometry = np.array([belief.x0, belief.y0, belief.h, belief.nx, belief.ny], dtype="<f8")
    return hashlib.sha256(geometry.tobytes() + belief.density.astype("<f8").tobytes()).hexdigest()


def _doubled(belief: GridBelief) -> GridBelief:
    """Both resolutions doubled; the four children share their parent's mass."""
    density = 0.25 * belief.density.repeat(2, axis=0).repeat(2, axis=1)
    return replace(belief, density=density, h=belief.h / 2.0, copies=2 * belief.copies)


def _crop_to(belief: GridBelief, extent: tuple[float, float, float, float]) -> GridBelief:
    """The cells that touch the rectangle `extent` (at least one), not normalized."""
    x_min, y_min, x_max, y_max = extent
    i0, i1 = aligned_range(x_min - belief.x0, x_max - belief.x0, belief.h, belief.nx)
    j0, j1 = aligned_range(y_min - belief.y0, y_max - belief.y0, belief.h, belief.ny)
    return replace(
        belief,
        density=np.ascontiguousarray(belief.density[j0:j1, i0:i1]),
        x0=belief.x0 + i0 * belief.h,
        y0=belief.y0 + j0 * belief.h,
    )


def aligned_range(low: float, high: float, h: float, n: int) -> tuple[int, int]:
    """First and past-last of n cells of size h that the interval [low, high] touches, never empty."""
    first = min(max(int(np.floor(low / h + _ALIGN)), 0), n - 1)
    return first, min(max(int(np.ceil(high / h - _ALIGN)), first + 1), n)


def extent_of(belief: GridBelief, cells: BoolArray) -> tuple[float, float, float, float]:
    """(x_min, y_min, x_max, y_max) of the marked cells' outer edges."""
    rows, columns = np.flatnonzero(cells.any(axis=1)), np.flatnonzero(cells.any(axis=0))
    x0, y0, h = belief.x0, belief.y0, belief.h
    return x0 + columns[0] * h, y0 + rows[0] * h, x0 + (columns[-1] + 1) * h, y0 + (rows[-1] + 1) * h


def _no_common_point(belief: GridBelief) -> InconsistentBearings:
    return InconsistentBearings(disagreement(belief.bearings + 1))


def _gaussian(prior: GaussianPrior, x: FloatArray, y: FloatArray) -> FloatArray:
    covariance = np.asarray(prior.covariance, dtype=float)
    if covariance.shape != (2, 2) or not np.isfinite(covariance).all() or np.linalg.eigvalsh(covariance)[0] <= 0:
        raise PlannerError(UnusableGaussian())
    inverse = np.linalg.inv(covariance)
    dx, dy = x - prior.x, y - prior.y
    return np.exp(-0.5 * (inverse[0, 0] * dx**2 + 2 * inverse[0, 1] * dx * dy + inverse[1, 1] * dy**2))


def _ring_share(prior: RingPrior, x: FloatArray, y: FloatArray, h: float, samples: int = 4) -> FloatArray:
    """Share of each cell that lies between the two radii, from samples x samples points a cell."""
    offsets = ((np.arange(samples) + 0.5) / samples - 0.5) * h
    share = np.zeros_like(x)
    for ox in offsets:
        for oy in offsets:
            r = np.hypot(x + ox - prior.x, y + oy - prior.y)
            share += (prior.inner <= r) & (r <= prior.outer)
    return share / samples**2


def _clip_to_disc(area: Region, prior: RingPrior, corners: int = 96) -> Region:
    if not (np.isfinite([prior.x, prior.y, prior.inner, prior.outer]).all() and 0 <= prior.inner < prior.outer):
        raise PlannerError(UnusableRing())
    angles = 2 * np.pi * np.arange(corners) / corners
    around = prior.outer / np.cos(np.pi / corners)
    disc = np.column_stack([prior.x + around * np.cos(angles), prior.y + around * np.sin(angles)])
    clipped = tuple(clip_convex(ring, disc) for ring in area)
    possible = tuple(ring for ring in clipped if len(ring) >= 3 and abs(signed_area(ring)) > 0)
    if not possible:
        raise PlannerError(PriorOutsideArea())
    return possible
