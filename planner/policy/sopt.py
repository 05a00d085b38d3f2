"""SOPT: two places for a pseudo target, with as many bearings at each as the threshold needs (Vander Hook, T-RO 2015).

The pseudo target is the point of the 3-sigma ellipse nearest to the platform. Bearings at distance r1 on the straight
way to it and at r2 exactly perpendicular have tr J^-1 = sigma^2 (r1^2 / k1 + r2^2 / k2); of all k1, k2, r1 with
2 sqrt(tr J^-1) = mu the quickest is flown. Only planned bearings count in J, and the whole plan is flown before the
next: so it takes many more bearings than the others (thesis Table 4.2: 9 instead of 2.5).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from planner.belief.estimate import estimate
from planner.belief.grid import GridBelief
from planner.motion import flight_time
from planner.policy.feasible import nearest_feasible
from planner.policy.route import RoutePolicy
from planner.reasons import RoutePlanner
from planner.types import Estimate, FloatArray, Problem


@dataclass(frozen=True, slots=True)
class Sopt(RoutePolicy):
    """deviations: size of the ellipse. most: bearings tried at each place. distances: values of r1 tried."""

    planner: ClassVar[RoutePlanner] = "sopt"
    deviations: float = 3.0
    most: int = 30
    distances: int = 50

    def route(self, problem: Problem, belief: GridBelief, platform: tuple[float, float]) -> FloatArray:
        """(k1 + k2, 2) m."""
        estimated = estimate(belief, problem.estimator)
        here, centre = np.array(platform, dtype=np.float64), np.array([estimated.x, estimated.y])
        target = pseudo_target(estimated, here, self.deviations)
        k1, k2, r1, r2 = self._quickest(problem, float(np.hypot(*(target - here))))
        forward = (target - here) / max(float(np.hypot(*(target - here))), 1e-9)
        first = target - r1 * forward
        across = r2 * np.array([-forward[1], forward[0]])
        second = min((target + across, target - across), key=lambda place: float(np.hypot(*(place - centre))))
        first, second = (nearest_feasible(problem, belief, place) for place in (first, second))
        return np.concatenate([np.repeat(first[None], k1, axis=0), np.repeat(second[None], k2, axis=0)])

    def _quickest(self, problem: Problem, distance: float) -> tuple[int, int, float, float]:
        """k1, k2, r1, r2 of the least travel + measuring time, by exhaustive search."""
        k = np.arange(1, self.most + 1)
        k1, k2 = k[:, None, None], k[None, :, None]
        r1 = max(distance, 1e-6) * np.arange(1, self.distances + 1) / self.distances
        room = (problem.threshold / (2.0 * problem.sigma)) ** 2 - r1**2 / k1  # r2^2 / k2
        r2 = np.sqrt(np.maximum(room, 0.0) * k2)
        time = flight_time(problem.motion, distance - r1) + flight_time(problem.motion, np.hypot(r1, r2))
        time = np.where(room > 0, time + problem.measurement_time * (k1 + k2), np.inf)
        if not np.isfinite(time).any():
            r1_least = float(r1[0])
            return self.most, self.most, r1_least, r1_least
        i, j, d = np.unravel_index(int(np.argmin(time)), time.shape)
        return int(k[i]), int(k[j]), float(r1[d]), float(r2[i, j, d])


def pseudo_target(estimated: Estimate, platform: FloatArray, deviations: float, corners: int = 720) -> FloatArray:
    """(2,) m: the corner nearest to the platform of the `deviations`-sigma ellipse, drawn as a polygon of `corners`."""
    variances, axes = np.linalg.eigh(estimated.covariance)
    angles = 2 * np.pi * np.arange(corners) / corners
    circle = np.stack([np.cos(angles), np.sin(angles)])
    edge = (
        np.array([estimated.x, estimated.y])
        + deviations * (axes @ (np.sqrt(np.maximum(variances, 0))[:, None] * circle)).T
    )
    return edge[np.argmin(np.hypot(*(edge - platform).T))]


sopt = Sopt()
