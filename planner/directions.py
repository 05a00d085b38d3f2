"""In which direction the emitter is expected from a place, and the shortest arc that holds most of that.

    q(b) = sum_ij p_ij N(b - dir(x_ij - a); 0, s^2)  +  what the belief itself may miss, all round

with p the belief, a the place and s what a bearing from there is expected to be off by (4.2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from planner.belief.grid import GridBelief
from planner.types import FloatArray, IntArray

DIRECTIONS = 360
SURPRISE = 0.1
"""Share of bearings that point anywhere: the outlier rate of a fielded system."""


@dataclass(frozen=True, slots=True)
class Arc:
    """Directions from `begin`, ccw by `width`; both rad, 0 <= width <= 2 pi."""

    begin: float
    width: float


def expected_directions(belief: GridBelief, place: tuple[float, float], sigma: float) -> FloatArray:
    """(360,) probability at the angles 2 pi k / 360 ccw from east, summing to one. place: m ENU. sigma: rad.

    A cell that the place lies in says nothing of direction: its mass goes all round.
    """
    x, y = belief.centres()
    off_x, off_y = x[None, :] - place[0], y[:, None] - place[1]
    here = np.hypot(off_x, off_y) < belief.h
    at = np.rint(np.arctan2(off_y, off_x) / (2.0 * math.pi) * DIRECTIONS).astype(np.int64) % DIRECTIONS
    mass = np.bincount(at.ravel(), np.where(here, 0.0, belief.density).ravel(), DIRECTIONS)
    order = np.arange(DIRECTIONS // 2 + 1)
    # the wrapped normal's Fourier coefficients: exp(-(n sigma)^2 / 2)
    spread = np.fft.irfft(np.fft.rfft(mass) * np.exp(-0.5 * (order * sigma) ** 2), DIRECTIONS)
    spread = np.maximum(spread, 0.0)
    around = float(belief.density[here].sum())
    total = float(spread.sum())
    known = spread / total * (1.0 - around) if total > 0.0 else spread
    return np.asarray(known + (1.0 - float(known.sum())) / DIRECTIONS, dtype=np.float64)


def shortest_arc(mass: FloatArray, share: float) -> Arc:
    """The shortest arc of whole directions that holds at least `share` of `mass` (m,), which sums to one."""
    count = mass.size
    twice = np.concatenate(([0.0], np.cumsum(np.concatenate((mass, mass)))))
    # the first end at which the mass since each begin is enough
    ends: IntArray = np.searchsorted(twice, twice[:count] + share * twice[count] - 1e-12)
    widths = np.minimum(ends - np.arange(count), count)
    first = int(np.argmin(widths))
    step = 2.0 * math.pi / count
    return Arc((first - 0.5) * step % (2.0 * math.pi), float(widths[first]) * step)
