"""What an action selection asks and answers: usable on any stochastic function of finitely many actions.

`sample(actions, path_from, path_to)` returns the costs of some actions on some sample paths. The j-th path of a common
random number source is the same for every action; an independent source ignores the agreement and draws afresh.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from planner.types import FloatArray, IntArray


class Sample(Protocol):
    """Costs (k, path_to - path_from), s, of actions (k,) on the sample paths path_from <= j < path_to."""

    def __call__(self, actions: IntArray, path_from: int, path_to: int, /) -> FloatArray:
        """Row i is the cost of actions[i], column j that on path path_from + j."""
        ...


@dataclass(frozen=True, slots=True)
class SelectionResult:
    """What a selection learned of each of n actions.

    best: index of the action with the least mean among those that survived. means: (n,), NaN where never sampled.
    std_errors: (n,) of the mean, NaN with fewer than two samples. counts: (n,) samples spent.
    dropped_in_round: (n,) 1-based round that eliminated the action, 0 for those that survived to the end.
    """

    best: int
    means: FloatArray
    std_errors: FloatArray
    counts: IntArray
    dropped_in_round: IntArray


class Selection(Protocol):
    """Chooses among `n_actions` within `budget` samples; `rng` is the only source of its own randomness."""

    def __call__(self, sample: Sample, n_actions: int, budget: int, rng: np.random.Generator) -> SelectionResult:
        """budget: samples of all actions together."""
        ...
