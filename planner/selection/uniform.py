"""Uniform allocation: every action gets the same number of sample paths, the least mean wins (thesis ch. 5)."""

from __future__ import annotations

import numpy as np

from planner.selection.tally import Tally, check_budget, spread_evenly
from planner.selection.types import IntArray, Sample, SelectionResult
from planner.types import FloatArray


def uniform(
    sample: Sample,
    n_actions: int,
    budget: int,
    rng: np.random.Generator,
    *,
    least: FloatArray | None = None,
    stride: int = 1,
) -> SelectionResult:
    """R = floor(N / n) paths for each of n actions; with N < n, one path for N evenly spread actions.

    least: (n,) lower bound of any single cost of each action. With it, an action is given up as soon as its partial
    sum plus the least possible rest exceeds the best complete sum, looked at every `stride` paths. That is exact: the
    chosen action is the one that the whole budget would have chosen, given that path j costs the same whenever asked.
    """
    del rng  # the allocation is fixed
    check_budget(n_actions, budget)
    actions = spread_evenly(n_actions, min(n_actions, budget))
    paths = max(1, budget // n_actions)
    tally = Tally(n_actions)
    if least is None:
        tally.add(actions, sample(actions, 0, paths))
    else:
        _sample_with_pruning(sample, tally, actions, paths, least, stride)
    return tally.result(_least_complete_mean(tally, paths))


def _sample_with_pruning(
    sample: Sample, tally: Tally, actions: IntArray, paths: int, least: FloatArray, stride: int
) -> None:
    first = min(stride, paths)
    tally.add(actions, sample(actions, 0, first))
    # The front runner is finished first: its complete sum is the bar that the others must stay below.
    leader = actions[np.argmin(tally.sums[actions])][None]
    if first < paths:
        tally.add(leader, sample(leader, first, paths))
    bar = float(tally.sums[leader[0]])
    alive = actions[actions != leader[0]]
    for start in range(first, paths, stride):
        alive = alive[tally.sums[alive] + (paths - start) * least[alive] <= bar]
        if not len(alive):
            return
        stop = min(start + stride, paths)
        tally.add(alive, sample(alive, start, stop))


def _least_complete_mean(tally: Tally, paths: int) -> int:
    complete = tally.counts == paths
    return int(np.argmin(np.where(complete, tally.sums, np.inf)))
