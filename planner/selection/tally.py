"""Running sums of the samples that an action selection has seen."""

from __future__ import annotations

import numpy as np

from planner.reasons import UnusableNumber
from planner.selection.types import SelectionResult
from planner.types import FloatArray, IntArray, PlannerError


class Tally:
    """Count, mean and spread of the costs of n actions; grows by `add`, answers as a `SelectionResult`."""

    def __init__(self, n_actions: int) -> None:
        self.counts: IntArray = np.zeros(n_actions, dtype=np.int64)
        self.sums: FloatArray = np.zeros(n_actions)
        self._squares: FloatArray = np.zeros(n_actions)
        self._origin = 0.0  # costs are summed relative to the first one seen: keeps the variance free of cancellation
        self.dropped_in_round: IntArray = np.zeros(n_actions, dtype=np.int64)

    def add(self, actions: IntArray, costs: FloatArray) -> None:
        """Take in `costs` (k, m) of `actions` (k,), each named at most once; ill-shaped or NaN costs are refused."""
        if costs.ndim != 2 or costs.shape[0] != len(actions):
            raise ValueError(f"a sample of {len(actions)} actions must give a row each, got shape {costs.shape}")
        if np.isnan(costs).any():
            raise ValueError("a sampled cost is NaN: the stochastic function must give a number for every action")
        if not self.counts.any() and costs.size:
            finite = costs[np.isfinite(costs)]
            self._origin = float(finite[0]) if finite.size else 0.0
        self.counts[actions] += costs.shape[1]
        self.sums[actions] += costs.sum(axis=1)
        self._squares[actions] += ((costs - self._origin) ** 2).sum(axis=1)

    def means(self) -> FloatArray:
        """(n,) mean cost, NaN where nothing was sampled."""
        with np.errstate(invalid="ignore"):
            return np.where(self.counts > 0, self.sums / np.maximum(self.counts, 1), np.nan)

    def std_errors(self) -> FloatArray:
        """(n,) standard error of the mean, NaN with fewer than two samples or an infinite cost."""
        n = np.maximum(self.counts, 2)
        with np.errstate(invalid="ignore"):
            shift = self.means() - self._origin
            variance = np.maximum(self._squares - self.counts * shift**2, 0.0) / (n - 1)
            return np.where((self.counts >= 2) & np.isfinite(self.sums), np.sqrt(variance / n), np.nan)

    def result(self, best: int) -> SelectionResult:
        """What has been learned so far, with the chosen action."""
        return SelectionResult(best, self.means(), self.std_errors(), self.counts, self.dropped_in_round)


def check_budget(n_actions: int, budget: int) -> None:
    """Refuse a selection among nothing or with nothing to spend."""
    if n_actions < 1:
        raise PlannerError(UnusableNumber("actions", "at_least_one", str(n_actions)))
    if budget < 1:
        raise PlannerError(UnusableNumber("budget", "at_least_one", str(budget)))


def spread_evenly(n_actions: int, n_kept: int) -> IntArray:
    """Indices (n_kept,) of a subset at equal steps through 0 .. n_actions - 1; all of them when the budget allows."""
    return np.unique(((np.arange(n_kept) + 0.5) * n_actions / n_kept).astype(np.int64))
