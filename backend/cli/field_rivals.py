"""What others would fly in the field world: planners that a mission's specification does not name."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from planner.airspace import may_fly
from planner.belief.grid import GridBelief
from planner.kernels.entropy import expected_entropies
from planner.policy.actions import action_space
from planner.policy.entropy import entpp
from planner.policy.fisher import fisher
from planner.sampling import equal_mass_points
from planner.types import FloatArray, Problem

STEP_M = 30.0
"""Between the nine places that the greedy planner compares."""

Rival = Callable[[Problem, GridBelief, tuple[float, float], np.random.Generator], tuple[float, float]]
"""A planner that a mission's specification does not name: the next place, m ENU."""


def _entropy_of_nine(
    problem: Problem, belief: GridBelief, here: tuple[float, float], rng: np.random.Generator
) -> tuple[float, float]:
    """Stay, or one step in eight directions: the least expected entropy, averaged over eight bearings."""
    steps = STEP_M * np.array([(0.0, 0.0), *((np.cos(a), np.sin(a)) for a in np.arange(8) * np.pi / 4)])
    places = np.array(here) + steps
    allowed = may_fly(problem, places)
    places = places[allowed] if allowed.any() else action_space(problem, belief)
    rows, columns = np.nonzero(belief.density > 1e-12 * belief.density.max())
    x, y = belief.centres()
    cells, mass = np.column_stack([x[columns], y[rows]]), belief.density[rows, columns]
    found = expected_entropies(cells, mass, places, equal_mass_points(belief, 8), problem.sigma)
    return _of(places, int(np.argmin(found)))


def _random_walk(
    problem: Problem, belief: GridBelief, here: tuple[float, float], rng: np.random.Generator
) -> tuple[float, float]:
    places = action_space(problem, belief)
    return _of(places, int(rng.integers(len(places))))


def _of(places: FloatArray, index: int) -> tuple[float, float]:
    return float(places[index, 0]), float(places[index, 1])


def _fisher(
    problem: Problem, belief: GridBelief, here: tuple[float, float], rng: np.random.Generator
) -> tuple[float, float]:
    choice = fisher(problem, belief, here)
    return choice.x, choice.y


def _entpp(
    problem: Problem, belief: GridBelief, here: tuple[float, float], rng: np.random.Generator
) -> tuple[float, float]:
    choice = entpp(problem, belief, here)
    return choice.x, choice.y


RIVALS: Mapping[str, Rival] = {
    "fisher": _fisher,
    "entpp": _entpp,
    "entropy_of_nine": _entropy_of_nine,
    "random_walk": _random_walk,
}
