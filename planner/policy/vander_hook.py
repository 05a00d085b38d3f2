"""Cautious greedy strategy: beside the ellipse, perpendicular to its major axis (Vander Hook et al., JFR 2014)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.belief.estimate import estimate
from planner.belief.grid import GridBelief
from planner.policy.feasible import nearest_feasible
from planner.reasons import BesideEllipse
from planner.types import Decision, Problem


@dataclass(frozen=True, slots=True)
class CautiousGreedy:
    """As near to the estimate as its uncertainty allows: `deviations` standard deviations along the minor axis."""

    deviations: float = 3.0

    def __call__(
        self,
        problem: Problem,
        belief: GridBelief,
        platform: tuple[float, float],
        rng: np.random.Generator | None = None,
    ) -> Decision:
        """The place on the platform's side of the major axis. `rng` is not used."""
        estimated = estimate(belief, problem.estimator)
        variances, axes = np.linalg.eigh(estimated.covariance)
        minor = axes[:, 0]
        centre = np.array([estimated.x, estimated.y])
        side = 1.0 if minor @ (np.array(platform) - centre) >= 0 else -1.0
        wanted = centre + side * self.deviations * np.sqrt(variances[0]) * minor
        x, y = nearest_feasible(problem, belief, wanted)
        return Decision(float(x), float(y), reason=BesideEllipse("just_outside"))


vander_hook = CautiousGreedy()
