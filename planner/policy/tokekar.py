"""Three planners for bearing-only telemetry (Tokekar, Vander Hook & Isler, IROS 2011).

Subset: the K of all candidate places whose bearings have the largest Fisher determinant for the estimate. Worst case:
the next place whose determinant is largest for the least favourable target in the ellipse. Tree: the sequence of moves
whose posterior determinant is smallest when nature picks the worst measurements, flown open loop.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations, permutations, product
from typing import ClassVar

import numpy as np

from planner.belief.estimate import estimate
from planner.belief.grid import GridBelief
from planner.policy.actions import constrained_actions
from planner.policy.feasible import nearest_feasible
from planner.policy.information import bearing_gradient, bearing_information, prior_information
from planner.policy.route import RoutePolicy
from planner.reasons import MostInformation, RoutePlanner
from planner.types import Decision, FloatArray, Problem


@dataclass(frozen=True, slots=True)
class Subset(RoutePolicy):
    """Exhaustive choice of `bearings` places on a coarse action grid, then the shortest way through them."""

    planner: ClassVar[RoutePlanner] = "tokekar_subset"
    bearings: int = 3
    grid: tuple[int, int] = (6, 6)

    def __post_init__(self) -> None:
        if not 1 <= self.bearings <= 4:
            raise ValueError(f"an exhaustive search takes 1 to 4 bearings at a time, got {self.bearings}")

    def route(self, problem: Problem, belief: GridBelief, platform: tuple[float, float]) -> FloatArray:
        """(K, 2) m."""
        estimated = estimate(belief, problem.estimator)
        coarse = replace(problem, action_grid=self.grid, action_spacing=None)
        places = constrained_actions(coarse, belief)
        chosen = np.array(list(combinations(range(len(places)), min(self.bearings, len(places)))))
        each = bearing_information(places, np.array([estimated.x, estimated.y]), problem.sigma, nearest=belief.h)
        known = prior_information(estimated)
        best = chosen[np.argmax(np.linalg.det(known + each[chosen].sum(axis=1)))]
        orders = [places[list(order)] for order in permutations(best)]
        return min(orders, key=lambda way: _length(np.vstack([platform, way])))


@dataclass(frozen=True, slots=True)
class WorstCase:
    """Myopic: max over places of the min over targets of det(P^-1 + J).

    The targets are the estimate and `targets` points around the `deviations`-sigma ellipse.
    """

    deviations: float = 2.0
    targets: int = 12

    def __call__(
        self,
        problem: Problem,
        belief: GridBelief,
        platform: tuple[float, float],
        rng: np.random.Generator | None = None,
    ) -> Decision:
        """`platform` and `rng` are not used."""
        estimated = estimate(belief, problem.estimator)
        places = constrained_actions(problem, belief)
        angles = 2 * np.pi * np.arange(self.targets) / self.targets
        root = np.linalg.cholesky(estimated.covariance + 1e-9 * np.eye(2))
        around = self.deviations * np.stack([np.cos(angles), np.sin(angles)], axis=1) @ root.T
        targets = np.array([estimated.x, estimated.y]) + np.vstack([np.zeros(2), around])
        known = prior_information(estimated)
        determinants = np.linalg.det(
            known
            + bearing_information(places[:, None], targets, problem.sigma, nearest=max(belief.h, problem.threshold))
        )
        best = int(np.argmax(determinants.min(axis=1)))
        x, y = places[best]
        return Decision(float(x), float(y), reason=MostInformation(len(places), "worst_case"))


@dataclass(frozen=True, slots=True)
class Tree(RoutePolicy):
    """Min over move sequences, max over measurement sequences, of det P after an EKF has taken them all.

    depth: moves of `step` m into one of `directions`. Nature's measurements err by -2, 0 or 2 standard deviations.
    """

    planner: ClassVar[RoutePlanner] = "tokekar_tree"
    depth: int = 3
    step: float = 40.0
    directions: int = 8
    errors: tuple[float, ...] = (-2.0, 0.0, 2.0)

    def __post_init__(self) -> None:
        if self.depth < 1 or not self.step > 0 or self.directions < 2:
            raise ValueError("the tree needs a depth of 1 or more, a positive step and at least two directions")
        if (self.directions * len(self.errors)) ** self.depth > 2_000_000:
            raise ValueError("the tree has more than two million leaves: lower its depth or its directions")

    def route(self, problem: Problem, belief: GridBelief, platform: tuple[float, float]) -> FloatArray:
        """(depth, 2) m."""
        estimated = estimate(belief, problem.estimator)
        angles = 2 * np.pi * np.arange(self.directions) / self.directions
        moves = self.step * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        sequences = np.array(list(product(range(self.directions), repeat=self.depth)))
        ways = np.array(platform) + np.cumsum(moves[sequences], axis=1)  # (s, depth, 2)
        errors = np.array(list(product(self.errors, repeat=self.depth)))  # (m, depth)
        mean = np.broadcast_to(np.array([estimated.x, estimated.y]), (len(ways), len(errors), 2))
        covariance = np.broadcast_to(estimated.covariance, (len(ways), len(errors), 2, 2))
        for level in range(self.depth):
            mean, covariance = _ekf(
                mean, covariance, ways[:, None, level], errors[None, :, level], problem.sigma, belief.h
            )
        worst = np.linalg.det(covariance).max(axis=1)
        best = ways[int(np.argmin(worst))]
        return np.array([nearest_feasible(problem, belief, place) for place in best])


def _ekf(
    mean: FloatArray, covariance: FloatArray, place: FloatArray, error: FloatArray, sigma: float, nearest: float
) -> tuple[FloatArray, FloatArray]:
    """One EKF update of (..., 2) means with a bearing from `place` that errs by `error` innovation deviations."""
    relative = mean - place
    r2 = np.maximum((relative**2).sum(axis=-1), nearest**2)
    h = bearing_gradient(relative, r2)
    ph = np.einsum("...ij,...j->...i", covariance, h)
    s = (h * ph).sum(axis=-1) + sigma**2
    updated = mean + ph * (error / np.sqrt(s))[..., None]
    return updated, covariance - ph[..., :, None] * ph[..., None, :] / s[..., None, None]


def _length(way: FloatArray) -> float:
    return float(np.hypot(*np.diff(way, axis=0).T).sum())


tokekar_subset = Subset()
tokekar_worst_case = WorstCase()
tokekar_tree = Tree()
