"""Uniform allocation: every action gets the same number of sample paths, the least mean wins (thesis ch. 5)."""

from __future__ import annotations

import numpy as np

from planner.selection.tally import Tally, check_budget, spread_evenly
from planner.selection.types import Sample, SelectionResult
from planner.types import FloatArray, IntArray

ROUNDING = 1e-12
"""Of a sum: what is equal but for rounding is not given up."""


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
    chosen action is the one that the whole budget would have chosen, given that path j costs the same at any time.
    What was given up counts as dropped in round 1; its mean is over its first paths only, and larger than the best.
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
    complete = tally.counts == paths
    tally.dropped_in_round[actions[~complete[actions]]] = 1
    return tally.result(int(np.argmin(np.where(complete, tally.sums, np.inf))))


def _sample_with_pruning(
    sample: Sample, tally: Tally, actions: IntArray, paths: int, least: FloatArray, stride: int
) -> None:
    costs = np.empty((len(actions), paths))
    spent = np.full(len(actions), min(stride, paths))
    costs[:, : spent[0]] = sample(actions, 0, int(spent[0]))
    # The front runner is finished first: its complete sum is the bar that the others must stay below.
    leader = int(np.argmin(costs[:, : spent[0]].sum(axis=1)))
    if spent[leader] < paths:
        costs[leader, spent[leader] :] = sample(actions[leader, None], int(spent[leader]), paths)[0]
    spent[leader] = paths
    bar = float(costs[leader].sum()) * (1.0 + ROUNDING)
    alive = np.flatnonzero(spent < paths)
    for start in range(stride, paths, stride):
        lowest = costs[alive, :start].sum(axis=1) + (paths - start) * least[actions[alive]]
        alive = alive[lowest <= bar]
        if len(alive) == 0:
            break
        stop = min(start + stride, paths)
        costs[alive, start:stop] = sample(actions[alive], start, stop)
        spent[alive] = stop
    for count in np.unique(spent):
        those = np.flatnonzero(spent == count)
        tally.add(actions[those], costs[those, :count])
