"""What the order of importance makes of several emitters' times: one mean, in which the first count most.

Of the ranks that are still looked for, the k-th (k = 0, 1, ..) has LESS^k of the weight of the first, shared out among
the n_k emitters that have it:

    V(a) = 1 / sum_e w_e E[T_e(a)],    w_e = LESS^k / n_k,    sum_e w_e = 1.

So a second of those that come first is worth 1 / LESS seconds of all that come next: where places differ for the first,
the first decide, and among places that are as good for them, the next ones. Emitters that are alike have equal weights,
which is the mean of `planner.policy.several`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.types import FloatArray

LESS = 0.1
"""docs/decisions/0054: reasoned, and flown; no other value was flown beside it."""


def weights_of(ranks: Sequence[int]) -> FloatArray | None:
    """(E,) weights that sum to 1, of emitters with these ranks, the lowest first; None where all are alike."""
    open_ranks = sorted(set(ranks))
    if len(open_ranks) < 2:
        return None
    weights = np.array([LESS ** open_ranks.index(rank) / ranks.count(rank) for rank in ranks])
    return weights / weights.sum()


def mean_time(costs: FloatArray, weights: FloatArray | None) -> FloatArray:
    """(k, paths) s of the emitters' times (E, k, paths)."""
    return costs.mean(axis=0) if weights is None else np.tensordot(weights, costs, axes=1)
