"""Entropy planners: measure where the expected bearing leaves the least Shannon entropy (spec 5).

ENTPP looks at the one bearing that points at the expected value, over 60 x 60 places (Cliff et al., RSS 2015). ENTPP-8
averages over eight deterministic samples of the belief, over 40 x 40 places.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from planner.belief.estimate import estimate
from planner.belief.grid import GridBelief
from planner.kernels.entropy import expected_entropies
from planner.policy.actions import constrained_actions
from planner.reasons import LeastEntropy, NoPlaceSeesBelief
from planner.sampling import equal_mass_points
from planner.types import Decision, PlannerError, Problem

NEGLIGIBLE_MASS = 1e-12
"""Cells lighter than this share of the heaviest do not move the entropy."""


@dataclass(frozen=True, slots=True)
class Entropy:
    """grid: X x Y action cells, instead of the problem's. samples: bearings looked at, a power of two.

    With one sample, the bearing points at the expected value whatever the localizer's estimator is.
    """

    grid: tuple[int, int] = (60, 60)
    samples: int = 1

    def __call__(
        self,
        problem: Problem,
        belief: GridBelief,
        platform: tuple[float, float],
        rng: np.random.Generator | None = None,
    ) -> Decision:
        """The place of least expected entropy; ties go to the one nearest to the platform. `rng` is not used."""
        places = constrained_actions(replace(problem, action_grid=self.grid), belief)
        if self.samples == 1:
            mean = estimate(belief, "expected_value")
            aims = np.array([[mean.x, mean.y]])
        else:
            aims = equal_mass_points(belief, self.samples)
        rows, columns = np.nonzero(belief.density > NEGLIGIBLE_MASS * belief.density.max())
        x, y = belief.centres()
        cells = np.column_stack([x[columns], y[rows]])
        entropies = expected_entropies(cells, belief.density[rows, columns], places, aims, problem.sigma)
        least = float(entropies.min())
        if not np.isfinite(least):
            raise PlannerError(NoPlaceSeesBelief())
        equal = np.flatnonzero(entropies <= least + 1e-9)
        best = equal[np.argmin(np.hypot(*(places[equal] - np.array(platform)).T))]
        return Decision(
            float(places[best, 0]),
            float(places[best, 1]),
            reason=LeastEntropy(least, len(places)),
        )


entpp = Entropy()
entpp8 = Entropy(grid=(40, 40), samples=8)
