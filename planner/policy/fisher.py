"""Fisher policy: measure where the Fisher information determinant grows most (spec 3, thesis 6.2.2).

argmax_a det(P^-1 + J(x~, a)), J = 1 / (r^4 sigma^2) [[y^2, -xy], [-xy, x^2]], (x, y) the estimate relative to a (3.77).
J = g g^T has rank one, det(P^-1 + J) = det(P^-1) (1 + g^T P g): only g^T P g needs to be compared.
"""

from __future__ import annotations

import numpy as np

from planner.belief.estimate import estimate
from planner.belief.grid import GridBelief
from planner.policy.actions import constrained_actions
from planner.reasons import MostInformation
from planner.types import Decision, Estimate, FloatArray, Problem


def fisher(
    problem: Problem, belief: GridBelief, platform: tuple[float, float], rng: np.random.Generator | None = None
) -> Decision:
    """The allowed place with the largest information determinant; `platform` and `rng` are not used."""
    places = constrained_actions(problem, belief)
    estimated = estimate(belief, problem.estimator)
    gains = information_gain(estimated, places, nearest=belief.h)
    best = first_best(gains)
    return Decision(
        float(places[best, 0]),
        float(places[best, 1]),
        reason=MostInformation(len(places), "estimate"),
    )


def information_gain(estimated: Estimate, places: FloatArray, nearest: float) -> FloatArray:
    """(n,) sigma^2 g^T P g of each place; places nearer to the estimate than `nearest` m count as that far."""
    x, y = estimated.x - places[:, 0], estimated.y - places[:, 1]
    r2 = np.maximum(x**2 + y**2, nearest**2)
    (xx, xy), (_, yy) = estimated.covariance
    return (xx * y**2 - 2.0 * xy * x * y + yy * x**2) / r2**2


def first_best(gains: FloatArray, margin: float = 1e-9) -> int:
    """Index of the first of (n,) values >= 0 that is the largest, up to a relative `margin`."""
    return int(np.argmax(gains >= gains.max() * (1.0 - margin)))
