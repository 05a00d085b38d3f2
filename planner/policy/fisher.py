"""Fisher policy: measure where the Fisher information determinant grows most (spec 3, thesis 6.2.2).

argmax_a det(P^-1 + J(x~, a)), J = 1 / (r^4 sigma^2) [[y^2, -xy], [-xy, x^2]], (x, y) the estimate relative to a (3.77).
J = g g^T has rank one, det(P^-1 + J) = det(P^-1) (1 + g^T P g): only g^T P g needs to be compared.
"""

from __future__ import annotations

import numpy as np

from planner.belief.estimate import estimate
from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief
from planner.belief.source_errors import SourceErrors
from planner.policy.actions import constrained_actions
from planner.reasons import MostInformation
from planner.types import Decision, Estimate, FloatArray, Problem


def fisher(
    problem: Problem, belief: GridBelief, platform: tuple[float, float], rng: np.random.Generator | None = None
) -> Decision:
    """The allowed place with the largest information determinant; `platform` and `rng` are not used."""
    places = constrained_actions(problem, belief)
    estimated = estimate(belief, problem.estimator)
    if isinstance(belief, JointBelief) and len(belief.errors) == 1:
        gains = gain_beside_bias(estimated, places, belief.errors[0], problem.sigma, nearest=belief.h)
    else:
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


def gain_beside_bias(
    estimated: Estimate, places: FloatArray, errors: SourceErrors, sigma: float, nearest: float
) -> FloatArray:
    """(n,) by what share each place shrinks the determinant of P when the bearing's bias b is uncertain, too.

    With z = dir(x) + b + w, c = cov(x, b), v = var(b), the bearing's covariance with the place is u = P g + c and its
    variance S = g^T P g + 2 g^T c + v + sigma^2: det P' = det P (1 - u^T P^-1 u / S). A place on the other side of the
    estimate turns the sign of g^T c, and so tells the bias from the place.
    """
    dx, dy = estimated.x - places[:, 0], estimated.y - places[:, 1]
    r2 = np.maximum(dx**2 + dy**2, nearest**2)
    g = np.column_stack([-dy / r2, dx / r2])
    covariance = estimated.covariance + np.eye(2) * (nearest**2 / 12.0)
    u = g @ covariance + errors.covariance_with_place
    spread = np.einsum("ni,ij,nj->n", g, covariance, g) + 2.0 * g @ errors.covariance_with_place
    variance = np.maximum(spread + errors.bias_sd**2, 0.0) + sigma**2
    return np.einsum("ni,ij,nj->n", u, np.linalg.inv(covariance), u) / variance


def telling_places(problem: Problem, belief: GridBelief, places: FloatArray, share: float) -> FloatArray:
    """Those of the places (n, 2) that gain at least `share` of the best one's, an uncertain bias counted in.

    All of them for a belief that knows no bias. Rollouts take the bearings to come as independent: among these places
    they may choose, since each of them tells the bias from the place.
    """
    if not isinstance(belief, JointBelief) or len(belief.errors) != 1:
        return places
    estimated = estimate(belief, problem.estimator)
    gains = gain_beside_bias(estimated, places, belief.errors[0], problem.sigma, nearest=belief.h)
    return places[gains >= share * gains.max()]


def first_best(gains: FloatArray, margin: float = 1e-9) -> int:
    """Index of the first of (n,) values >= 0 that is the largest, up to a relative `margin`."""
    return int(np.argmax(gains >= gains.max() * (1.0 - margin)))
