"""In which direction the emitter is expected from a place, and the shortest arc that holds most of that.

    q(b) = sum_ij p_ij N(b - dir(x_ij - a); 0, s^2)  +  what the belief itself may miss, all round

with p the belief, a the place and s what a bearing from there is expected to be off by (4.2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from planner.belief.grid import GridBelief
from planner.types import FloatArray, SectorTurns

DIRECTIONS = 360
COARSE = 72
MOST_CELLS, LIGHT = 400, 0.01
"""How finely places are compared by their turns: a few degrees of a sector are a tenth of a second."""
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
    ends = np.asarray(np.searchsorted(twice, twice[:count] + share * twice[count] - 1e-12), dtype=np.int64)
    widths = np.minimum(ends - np.arange(count), count)
    first = int(np.argmin(widths))
    step = 2.0 * math.pi / count
    return Arc((first - 0.5) * step % (2.0 * math.pi), float(widths[first]) * step)


def turning_lead(rule: SectorTurns, belief: GridBelief, places: FloatArray, sigma: float) -> FloatArray:
    """(n,) s by which the turn at each of the places (n, 2), m ENU, takes longer than at their mean; 0 before the first
    bearing, when every turn is a whole one. sigma: rad."""
    if belief.bearings == 0 or len(places) == 0:
        return np.zeros(len(places))
    cells, mass = _heaviest(belief)
    off = cells[None, :, :] - places[:, None, :]
    step = 2.0 * math.pi / COARSE
    at = np.rint(np.arctan2(off[..., 1], off[..., 0]) / step).astype(np.int64) % COARSE
    row = np.arange(len(places))[:, None] * COARSE
    weight = np.broadcast_to(mass, at.shape)
    found = np.bincount((row + at).ravel(), weight.ravel(), len(places) * COARSE).reshape(-1, COARSE)
    order = np.arange(COARSE // 2 + 1)
    found = np.fft.irfft(np.fft.rfft(found, axis=1) * np.exp(-0.5 * (order * sigma) ** 2), COARSE, axis=1)
    found = np.maximum(found, 0.0)
    found = found / found.sum(axis=1, keepdims=True)
    widths = np.array([rule.width(shortest_arc(one, rule.share).width) for one in found])
    return np.asarray((widths - widths.mean()) / rule.turn_rate, dtype=np.float64)


def _heaviest(belief: GridBelief) -> tuple[FloatArray, FloatArray]:
    """Centres (n, 2) and mass (n,) of at most MOST_CELLS cells, evenly taken from those that carry any."""
    rows, columns = np.nonzero(belief.density > LIGHT * belief.density.max())
    every = -(-len(rows) // MOST_CELLS)
    rows, columns = rows[::every], columns[::every]
    x, y = belief.centres()
    return np.column_stack([x[columns], y[rows]]), belief.density[rows, columns]
