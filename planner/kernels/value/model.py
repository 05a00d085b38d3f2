"""The Gaussian dynamic program as numbers: its grids, what one bearing makes of a Gaussian belief, and its value.

State: a belief N(0, diag(s1^2, s2^2)), s1 >= s2, and the platform's place. Seen from the mean, along the principal
axes and in units of s1 the place is u = (u1, u2) >= 0 (the state is symmetric about both axes); rho = s1 / s2. What a
bearing does to the belief's shape depends on (rho, u) and sigma alone: the problem has no other length.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from planner.types import FloatArray

SCALES = 24
RATIOS = 12
NODES = 20
"""Grid points: of s1 / threshold, of rho, and of each axis of u."""

SMALLEST_SCALE, LARGEST_SCALE = 0.6, 26.0
"""s1 / threshold: below, every belief is localized (E d >= 0.8 s1); above, values go on as at the edge."""
LARGEST_RATIO = 20.0
NEAR, FAR = 0.766, 3.3
"""u_k = NEAR (e^(FAR k / (NODES - 1)) - 1): 0 to 20, dense where the belief is."""

DRAWS = 64
"""Quasi-random triples (target, bearing noise) a transition is averaged over."""

SCALE_STEP = float(np.log(LARGEST_SCALE / SMALLEST_SCALE) / (SCALES - 1))
RATIO_STEP = float(np.log(LARGEST_RATIO) / (RATIOS - 1))
NODE_STEP = FAR / (NODES - 1)


class Transitions(NamedTuple):
    """What a bearing from node (i, j) makes of a belief of ratio r, draw k: shape (RATIOS, NODES, NODES, DRAWS) each.

    shrunk: log(s1' / s1). ratio: log rho'. u1, u2: the platform in the new frame. spread: E |x - median| / s1.
    """

    shrunk: FloatArray
    ratio: FloatArray
    u1: FloatArray
    u2: FloatArray
    spread: FloatArray


def ratios() -> FloatArray:
    """(RATIOS,) rho."""
    return np.exp(RATIO_STEP * np.arange(RATIOS))


def scales() -> FloatArray:
    """(SCALES,) s1 / threshold."""
    return SMALLEST_SCALE * np.exp(SCALE_STEP * np.arange(SCALES))


def nodes() -> FloatArray:
    """(NODES,) u along one axis."""
    return NEAR * np.expm1(NODE_STEP * np.arange(NODES))
