"""What a selection in a continuous action space asks and answers: places in a rectangle instead of a finite list."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from planner.reasons import BudgetTooSmall
from planner.selection.tally import Tally
from planner.types import FloatArray, IntArray, PlannerError


class SamplePlaces(Protocol):
    """Costs (k, path_to - path_from), s, of places (k, 2), m, on the sample paths path_from <= j < path_to."""

    def __call__(self, places: FloatArray, path_from: int, path_to: int, /) -> FloatArray:
        """Row i is the cost of places[i], column j that on path path_from + j."""
        ...


@dataclass(frozen=True, slots=True)
class Rectangle:
    """Axis-parallel, m: x0 < x1, y0 < y1."""

    x0: float
    y0: float
    x1: float
    y1: float

    def __post_init__(self) -> None:
        if not (self.x0 < self.x1 and self.y0 < self.y1):
            raise ValueError(f"the action rectangle {self} is empty: give x0 < x1 and y0 < y1")

    def clip(self, places: FloatArray) -> FloatArray:
        """The nearest places (k, 2) inside."""
        return np.clip(places, (self.x0, self.y0), (self.x1, self.y1))


@dataclass(frozen=True, slots=True)
class PlacesResult:
    """Every place visited, in order, and what was learned of it; `best` indexes the chosen one.

    places: (n, 2) m. means, std_errors: (n,) s, as in `SelectionResult`. counts: (n,) samples spent.
    """

    best: int
    places: FloatArray
    means: FloatArray
    std_errors: FloatArray
    counts: IntArray


class VisitedPlaces:
    """Collects the places that a continuous selection visits, each sampled once with a set of paths."""

    def __init__(self, sample: SamplePlaces) -> None:
        self._sample = sample
        self._places: list[FloatArray] = []
        self._costs: list[FloatArray] = []

    def visit(self, places: FloatArray, path_from: int, path_to: int, /) -> FloatArray:
        """Mean costs (k,) of new places (k, 2)."""
        costs = self._sample(places, path_from, path_to)
        self._places.append(np.array(places, dtype=np.float64))
        self._costs.append(costs)
        return costs.mean(axis=1)

    def result(self, best: int | None = None) -> PlacesResult:
        """All visits; `best` None means the one with the least mean."""
        places = np.concatenate(self._places)
        tally = Tally(len(places))
        first = 0
        for costs in self._costs:
            tally.add(np.arange(first, first + len(costs)), costs)
            first += len(costs)
        means = tally.means()
        chosen = int(np.argmin(means)) if best is None else best
        return PlacesResult(chosen, places, means, tally.std_errors(), tally.counts)

    def __len__(self) -> int:
        return sum(map(len, self._places))


def paths_per_place(budget: int, places: int) -> int:
    """R = floor(N / places) sample paths for each place; refuses a budget that gives none."""
    if budget < places:
        raise PlannerError(BudgetTooSmall(budget, places))
    return budget // places
