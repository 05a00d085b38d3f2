"""Ellipse policy: measure beside the covariance ellipse, perpendicular to its major axis (spec 3, thesis 4.3.2).

r = s2 PLI(s1 / s2), s1 >= s2 the semi-axes. PLI comes from `ellipse_table.json`, which `ellipse_table.py` computes.
"""

from __future__ import annotations

import json
from functools import cache

import numpy as np

from planner.belief.estimate import estimate
from planner.belief.grid import GridBelief
from planner.kernels.reference.belief import PointEstimate
from planner.kernels.reference.policy import ellipse_action
from planner.policy.ellipse_table import TABLE
from planner.reasons import BesideEllipse
from planner.types import Decision, FloatArray, Problem


def ellipse(
    problem: Problem, belief: GridBelief, platform: tuple[float, float], rng: np.random.Generator | None = None
) -> Decision:
    """The place beside the ellipse on the platform's side; it ignores constraints and `rng`."""
    estimated = estimate(belief, problem.estimator)
    (xx, xy), (_, yy) = estimated.covariance
    ratios, distances = table(problem.sigma)
    seen = PointEstimate(estimated.x, estimated.y, xx, xy, yy, estimated.expected_rmse)
    x, y = ellipse_action(seen, np.array(platform, dtype=float), ratios, distances)
    return Decision(float(x), float(y), reason=BesideEllipse("tabulated"))


def table(sigma: float) -> tuple[FloatArray, FloatArray]:
    """s1 / s2 (n,) and r / s2 (n,) for a bearing noise in rad, linear between the tabulated noises."""
    ratios, sigmas, distances = _read()
    at = min(max(sigma, float(sigmas[0])), float(sigmas[-1]))
    return ratios, np.array([np.interp(at, sigmas, distances[:, k]) for k in range(len(ratios))])


@cache
def _read() -> tuple[FloatArray, FloatArray, FloatArray]:
    stored = json.loads(TABLE.read_text())
    sigmas = np.deg2rad([float(s) for s in stored["distances"]])
    return np.array(stored["ratios"]), sigmas, np.array(list(stored["distances"].values()))
