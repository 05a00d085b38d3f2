"""What a policy is: one call signature for all of them, so that a study or a mission can swap one for another."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from planner.belief.grid import GridBelief
from planner.types import Decision, Problem


class Policy(Protocol):
    """Chooses the next measurement place from the belief and the platform's place (x, y), m ENU.

    `rng` is the only source of chance; deterministic policies ignore it. How many bearings have been taken is in the
    belief. Raises PlannerError when no place may be flown to.
    """

    def __call__(
        self, problem: Problem, belief: GridBelief, platform: tuple[float, float], rng: np.random.Generator
    ) -> Decision:
        """The place, and what the other candidates were worth."""
        ...


class DeterministicPolicy(Protocol):
    """A `Policy` that uses no chance: it may be called without a generator."""

    def __call__(
        self,
        problem: Problem,
        belief: GridBelief,
        platform: tuple[float, float],
        rng: np.random.Generator | None = None,
    ) -> Decision:
        """Equal beliefs get equal decisions; `rng` is ignored."""
        ...
