"""Bearings that are narrower than cells: where their lines cross, so that no cell's centre has to lie there by chance.

A bearing of 2 degrees is 2 m wide at 60 m. On cells of 20 m, as an area of 2 km begins with, the centres miss the place
where several such bearings cross, and what is left to the belief are outliers.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from planner.belief.evidence import SMALLEST_SIGMA
from planner.belief.same_place import by_place
from planner.types import Bearing, BoolArray, FloatArray

MOST_PLACES = 12
"""Every two of the places with the narrowest bearings are crossed, each by its narrowest one."""
TURNS = np.deg2rad(np.arange(-20.0, 20.5, 1.0))
"""rad, what the compass of all may be off by: two standard deviations of the worst."""
CELLS_A_WIDTH = 0.4
"""Cells resolve a crossing of bearings where its standard deviation is at least this many of them."""
APART_M = 1.0
"""Two sources nearer to each other look from one place."""


class Crossings(NamedTuple):
    """x, y: (m,) m ENU. width: (m,) m, standard deviation of the narrower of the two bearings there. bearings: how many
    there are in all."""

    x: FloatArray
    y: FloatArray
    width: FloatArray
    bearings: int

    def only(self, which: BoolArray) -> Crossings:
        """These of them."""
        return self._replace(x=self.x[which], y=self.y[which], width=self.width[which])

    def within(self, x0: float, y0: float, x1: float, y1: float) -> Crossings:
        """Those in a rectangle, m ENU."""
        return self.only((self.x > x0) & (self.x < x1) & (self.y > y0) & (self.y < y1))


def crossings(bearings: Sequence[Bearing]) -> Crossings:
    """Ahead of both, of bearings from every two places, turned together by each of TURNS."""
    narrowest = [min(there, key=lambda one: one.sigma) for there in by_place(bearings)]
    taken = sorted(narrowest, key=lambda one: one.sigma)[:MOST_PLACES]
    place = np.array([(b.x, b.y) for b in taken]).reshape(-1, 2)
    sigma = np.array([max(b.sigma, SMALLEST_SIGMA) for b in taken])
    first, second = np.triu_indices(len(taken), 1)
    far = np.hypot(*(place[second] - place[first]).T) >= APART_M
    first, second = first[far], second[far]
    angle = np.array([b.angle for b in taken])[:, None] - TURNS
    along = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    d1, d2, apart = along[first], along[second], (place[second] - place[first])[:, None, :]
    with np.errstate(divide="ignore", invalid="ignore"):
        # place_1 + s d1 = place_2 + t d2
        sine = d1[..., 0] * d2[..., 1] - d1[..., 1] * d2[..., 0]
        s = (apart[..., 0] * d2[..., 1] - apart[..., 1] * d2[..., 0]) / sine
        t = (apart[..., 0] * d1[..., 1] - apart[..., 1] * d1[..., 0]) / sine
        ahead = (s > 0.0) & (t > 0.0)
        found = place[first][:, None, :] + s[..., None] * d1
        width = np.minimum(s * sigma[first][:, None], t * sigma[second][:, None])
    return Crossings(found[ahead][:, 0], found[ahead][:, 1], width[ahead], len(bearings))
