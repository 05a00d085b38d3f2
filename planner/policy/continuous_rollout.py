"""Policy rollout over a continuous action space: quadrant search, gradient descent or BFGS choose the place (ch. 5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.belief.grid import GridBelief
from planner.options import BasePolicy, ContinuousSelection, Sampling
from planner.policy.actions import action_rectangle
from planner.policy.base import BASE_POLICIES
from planner.policy.feasible import nearest_feasible
from planner.policy.rollout import RolloutSampler
from planner.policy.simulation import HORIZON, KernelName, simulate
from planner.reasons import BudgetTooSmall, FixedSamplePaths, QuickestPlaceFound
from planner.selection.bfgs import bfgs
from planner.selection.continuous import PlacesResult, Rectangle, SamplePlaces
from planner.selection.quadrant import quadrant_search
from planner.selection.sgd import sgd
from planner.types import Candidate, Decision, FloatArray, PlannerError, Problem

NO_WAY = 1e6
"""s, the cost of a place without a way to it: a gradient cannot use infinity."""


@dataclass(frozen=True, slots=True)
class ContinuousRollout:
    """The rollout policy in the tripled belief rectangle, cut with the flight area's, as a `Policy`.

    levels: L of the quadrant search; its R follows from the budget N = R (9 + 5 L). paths: R of the descents. With
    deterministic sampling there are as many paths as the selection needs for a place, a power of two.
    """

    selection: ContinuousSelection
    sampling: Sampling
    base_policy: BasePolicy
    budget: int
    threads: int = 1
    horizon: int = HORIZON
    kernel: KernelName = "compiled"
    levels: int = 4
    paths: int = 8

    def __call__(
        self, problem: Problem, belief: GridBelief, platform: tuple[float, float], rng: np.random.Generator
    ) -> Decision:
        """PlannerError when the budget does not reach for one sample path for every place the selection needs."""
        simulation = simulate(
            problem,
            belief,
            platform,
            base_policy=self.base_policy,
            horizon=self.horizon,
            threads=self.threads,
            kernel=self.kernel,
        )
        sampling = "deterministic" if self.selection == "bfgs" else self.sampling
        if sampling == "deterministic" and self.selection == "sgd":
            raise PlannerError(FixedSamplePaths(self.paths))
        budget, paths = self.budget, self.paths
        if sampling == "deterministic" and self.selection == "quadrant":
            places = 9 + 5 * self.levels
            if budget < places:
                raise PlannerError(BudgetTooSmall(budget, places))
            paths = 2 ** int(np.log2(budget // places))
            budget = paths * places
        sampler = RolloutSampler(simulation, belief, sampling, rng, paths=paths)

        def sample(places: FloatArray, path_from: int, path_to: int) -> FloatArray:
            costs = sampler.sample_places(places, path_from, path_to)
            return np.minimum(costs, NO_WAY)

        base = BASE_POLICIES[self.base_policy](problem, belief, platform, rng)
        result = self._select(sample, Rectangle(*action_rectangle(problem, belief)), (base.x, base.y), budget)
        wanted = result.places[result.best]
        x, y = nearest_feasible(problem, belief, wanted)
        return Decision(
            float(x),
            float(y),
            reason=QuickestPlaceFound(float(result.means[result.best]), self.selection),
            candidates=_candidates(result),
            rollouts=sampler.used,
        )

    def _select(
        self, sample: SamplePlaces, rectangle: Rectangle, start: tuple[float, float], budget: int
    ) -> PlacesResult:
        match self.selection:
            case "quadrant":
                return quadrant_search(sample, rectangle, budget, levels=self.levels)
            case "sgd":
                return sgd(sample, rectangle, start, budget, paths=self.paths)
            case "bfgs":
                return bfgs(sample, rectangle, start, budget, paths=self.paths)


def _candidates(result: PlacesResult) -> tuple[Candidate, ...]:
    return tuple(
        Candidate(float(x), float(y), float(mean), float(error), int(count), None)
        for (x, y), mean, error, count in zip(
            result.places, result.means, result.std_errors, result.counts, strict=True
        )
    )
