"""Reading the dynamic program's table: the belief's principal frame, and the seconds left from any place, in numpy."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from planner.kernels.value.model import NEAR, NODE_STEP, RATIO_STEP, SCALE_STEP, SMALLEST_SCALE
from planner.types import FloatArray, IntArray

ROUND = 1e-9
"""A belief whose axes differ by less than this share has none: its frame is that of the map."""


class Frame(NamedTuple):
    """The principal frame of a belief: mean (x, y), m, the major axis' direction (c, s), s1 >= s2, m."""

    x: float
    y: float
    c: float
    s: float
    s1: float
    s2: float

    def seen(self, places: FloatArray) -> FloatArray:
        """(2,) or (2, n) u, in units of s1, of places (2,) or (n, 2), m."""
        dx, dy = places[..., 0] - self.x, places[..., 1] - self.y
        return np.array([self.c * dx + self.s * dy, self.c * dy - self.s * dx]) / self.s1

    def places(self, u1: FloatArray, u2: FloatArray) -> FloatArray:
        """(n, 2) m of (n,) u along both axes."""
        a, b = self.s1 * u1, self.s1 * u2
        return np.column_stack([self.x + self.c * a - self.s * b, self.y + self.s * a + self.c * b])


def principal_frame(x: float, y: float, xx: float, xy: float, yy: float) -> Frame:
    """Of a covariance (m^2) about the mean."""
    mean, difference = 0.5 * (xx + yy), 0.5 * (xx - yy)
    spread = float(np.hypot(difference, xy))
    axis = 0.0 if spread <= ROUND * mean else 0.5 * float(np.arctan2(xy, difference))
    s1 = float(np.sqrt(mean + spread))
    return Frame(
        x, y, float(np.cos(axis)), float(np.sin(axis)), s1, max(float(np.sqrt(max(mean - spread, 0.0))), 1e-6 * s1)
    )


def blended(after: FloatArray, scale: float, ratio: float) -> FloatArray:
    """(NODES, NODES) s for s1 / threshold and rho, linear in both logarithms; as at the edge beyond the grid."""
    k, f = _between(np.log(scale / SMALLEST_SCALE) / SCALE_STEP, after.shape[0])
    r, g = _between(np.log(ratio) / RATIO_STEP, after.shape[1])
    low = (1.0 - g) * after[k, r] + g * after[k, r + 1]
    high = (1.0 - g) * after[k + 1, r] + g * after[k + 1, r + 1]
    side = round(np.sqrt(after.shape[2]))
    return np.asarray((1.0 - f) * low + f * high).reshape(side, side)


def after_at(after: FloatArray, nodes: FloatArray, frame: Frame, places: FloatArray) -> FloatArray:
    """(n,) s left after flying to places (n, 2), m: `blended` between the nodes, as at the edge beyond the last."""
    u1, u2 = np.abs(frame.seen(places))
    (i, f), (j, g) = (_between_nodes(u, nodes) for u in (u1, u2))
    low = (1.0 - g) * after[i, j] + g * after[i, j + 1]
    high = (1.0 - g) * after[i + 1, j] + g * after[i + 1, j + 1]
    return (1.0 - f) * low + f * high


def _between(at: float, count: int) -> tuple[int, float]:
    at = min(max(float(at), 0.0), count - 1.0)
    k = min(int(at), count - 2)
    return k, at - k


def _between_nodes(u: FloatArray, nodes: FloatArray) -> tuple[IntArray, FloatArray]:
    at = np.log1p(np.minimum(u, nodes[-1]) / NEAR) / NODE_STEP
    k = np.minimum(at.astype(np.int64), len(nodes) - 2)
    return k, at - k
