"""Sequential halving: rounds of equal budget, each keeping the better half (Karnin, Koren & Somekh, ICML 2013)."""

from __future__ import annotations

import math

import numpy as np

from planner.selection.tally import Tally, check_budget, spread_evenly
from planner.selection.types import Sample, SelectionResult


def rounds_for(n_actions: int) -> int:
    """ceil(log2 n) rounds leave one of n actions; a single action still gets one round, so that its value is known."""
    return max(1, math.ceil(math.log2(n_actions)))


def affordable_actions(n_actions: int, budget: int) -> int:
    """How many of `n_actions` can be given at least one sample path in the first round of `budget`."""
    kept = min(n_actions, budget)
    while kept > 1 and budget // rounds_for(kept) < kept:
        kept -= 1
    return kept


def sequential_halving(sample: Sample, n_actions: int, budget: int, rng: np.random.Generator) -> SelectionResult:
    """Each of ceil(log2 n) rounds shares floor(N / rounds) paths among the s survivors, floor of that each.

    The better ceil(s / 2) by the mean of all samples so far survive a round. When the budget cannot give every action
    one path in the first round, an evenly spread subset competes, and the others count as dropped in round 1 unsampled.
    """
    del rng  # the allocation follows from the sampled costs alone
    check_budget(n_actions, budget)
    survivors = spread_evenly(n_actions, affordable_actions(n_actions, budget))
    rounds = rounds_for(len(survivors))
    tally = Tally(n_actions)
    tally.dropped_in_round[np.setdiff1d(np.arange(n_actions), survivors)] = 1
    done = 0
    for number in range(1, rounds + 1):
        paths = budget // rounds // len(survivors)
        tally.add(survivors, sample(survivors, done, done + paths))
        done += paths
        order = np.argsort(tally.sums[survivors], kind="stable")
        keep = math.ceil(len(survivors) / 2)
        tally.dropped_in_round[survivors[order[keep:]]] = number
        survivors = survivors[np.sort(order[:keep])]
    return tally.result(int(survivors[0]))
