"""Where else the emitter may be: the separate high-density parts of a belief, and which bearings speak for each.

With an outlier mixture, bearings that disagree leave several such parts; the console shows each with its mass, and
rollouts, which draw their targets from the whole belief, choose the next place to tell them apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.belief.estimate import most_likely
from planner.belief.grid import GridBelief, smallest_set
from planner.belief.verdict import points_at
from planner.geometry import cells_hull
from planner.types import Bearing, BoolArray, Ring


@dataclass(frozen=True, slots=True, eq=False)
class Hypothesis:
    """One connected part of the cells that hold most of the mass.

    mass: its share of the belief. x, y: its heaviest cell, m ENU. hull: (n, 2) around it. supporting: indices of the
    bearings that point at (x, y) within 4 sigma (any peak); the others are outliers if this hypothesis is true.
    """

    mass: float
    x: float
    y: float
    hull: Ring
    supporting: tuple[int, ...]


def hypotheses(
    belief: GridBelief, bearings: Sequence[Bearing] = (), *, share: float = 0.95, least_mass: float = 0.01
) -> tuple[Hypothesis, ...]:
    """The parts of the smallest set with `share` of the mass, heaviest first, those below `least_mass` left out.

    Cells that touch at a corner belong together.
    """
    from scipy.ndimage import label  # loaded with the first question, not by every start

    parts = np.zeros(belief.density.shape, dtype=np.int32)
    label(smallest_set(belief, share), structure=np.ones((3, 3)), output=parts)
    found = [_hypothesis(belief, bearings, parts == number) for number in range(1, int(parts.max()) + 1)]
    kept = [one for one in found if one.mass >= least_mass]
    return tuple(sorted(kept, key=lambda one: -one.mass))


def _hypothesis(belief: GridBelief, bearings: Sequence[Bearing], cells: BoolArray) -> Hypothesis:
    rows, columns = np.nonzero(cells)
    mass = belief.density[rows, columns]
    heaviest = most_likely(mass)
    x0, y0, h = belief.x0, belief.y0, belief.h
    x, y = float(x0 + (columns[heaviest] + 0.5) * h), float(y0 + (rows[heaviest] + 0.5) * h)
    supporting = tuple(k for k, bearing in enumerate(bearings) if points_at(bearing, x, y))
    return Hypothesis(float(mass.sum()), x, y, cells_hull(cells, x0, y0, h), supporting)
