"""Policy rollout: compare first actions by simulating what the base policy would make of each (spec 4, thesis 4.3.3).

Value of a first action = its cost + the cost of following the base policy until localized, averaged over sample paths.
Which action is sampled on which path is the selection's business (planner.selection).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from planner.belief.grid import GridBelief
from planner.kernels.model import Actions, Paths, Tasks
from planner.legs import far_enough
from planner.options import BasePolicy, DiscreteSelection, Sampling
from planner.policy.actions import Usable, constrained_actions, with_own_echoes, without_refused
from planner.policy.claim_ahead import ClaimAhead, choice, claim_ahead
from planner.policy.dynamic_program import best_places, stands_on
from planner.policy.fisher import telling_places
from planner.policy.simulation import HORIZON, KernelName, Simulation, TerminalValue, rules_of, simulate
from planner.policy.value_table import ProgramTable
from planner.reasons import (
    BudgetTooSmall,
    ChoiceReason,
    EveryPlaceRefused,
    FixedSamplePaths,
    LongestLead,
    NoPlaceInReach,
    OnlyPlace,
    PlannedMeanwhile,
    QuickestPlace,
)
from planner.sampling import QUASI_DIMENSIONS, deterministic_paths, quasi_random_paths, random_paths
from planner.selection.sequential_halving import sequential_halving
from planner.selection.types import Selection, SelectionResult
from planner.selection.uniform import uniform
from planner.types import Candidate, Decision, FloatArray, IntArray, PlannerError, Problem

SELECTIONS: Mapping[DiscreteSelection, Selection] = {"uniform": uniform, "sequential_halving": sequential_halving}

PROGRAM_PLACES = 24
"""How many places rollouts on the dynamic program compare; it names them itself."""

PROGRAM_HORIZON = 2
"""Bearings after which the dynamic program closes a rollout: the first action's and its own first."""

PATH_BLOCK = 64
"""Common random paths are drawn in blocks of this size, so that path j does not depend on who needs it first."""

FORECAST_PATHS = 128
"""Sample paths followed to their end for the times left, where those of the choice were closed with a mean."""

TELLING_SHARE = 0.8
"""With a joint belief: of the best place's gain, what a place must offer to be compared at all."""

MOST_LOOKS = 16
"""How often uniform allocation stops to see which actions have lost: every call of the kernel costs some time."""


@dataclass(slots=True)
class RolloutSampler:
    """Costs of first actions on sample paths: the `sample` that selections call, which remembers the answers.

    `paths` deterministic: how many equal-mass paths there are (a power of two).
    """

    simulation: Simulation
    belief: GridBelief
    sampling: Sampling
    rng: np.random.Generator
    places: FloatArray = field(default_factory=lambda: np.empty((0, 2)))
    paths: int = 8
    used: int = 0
    seen: dict[int, list[FloatArray]] = field(default_factory=dict[int, list[FloatArray]])
    _actions: Actions | None = None
    _pool: Paths | None = None
    _shift: FloatArray | None = None

    def sample(self, actions: IntArray, path_from: int, path_to: int) -> FloatArray:
        """(k, path_to - path_from) s: the `Sample` over `places`."""
        if self._actions is None:
            self._actions = self.simulation.first_actions(self.places)
        costs = self._costs(self._actions, np.asarray(actions, dtype=np.int64), path_from, path_to)
        for index, row in zip(actions, costs, strict=True):
            self.seen.setdefault(int(index), []).append(row)
        return costs

    def sample_places(self, places: FloatArray, path_from: int, path_to: int) -> FloatArray:
        """(k, path_to - path_from) s: the `SamplePlaces` of continuous selections."""
        actions = self.simulation.first_actions(places)
        return self._costs(actions, np.arange(len(places)), path_from, path_to)

    def _costs(self, actions: Actions, chosen: IntArray, path_from: int, path_to: int) -> FloatArray:
        count = path_to - path_from
        if self.sampling == "pmc":
            pool = self._draw(len(chosen) * count)
            path = np.arange(len(chosen) * count)
        else:
            pool = self._common(path_to)
            path = np.tile(np.arange(path_from, path_to), len(chosen))
        tasks = Tasks(np.repeat(chosen, count), path)
        self.used += len(path)
        return self.simulation.run(actions, pool, tasks).costs.reshape(len(chosen), count)

    def _common(self, count: int) -> Paths:
        if self.sampling == "deterministic":
            if self._pool is None:
                self._pool = deterministic_paths(self.belief, self.paths, self.simulation.rules.horizon)
            if count > self.paths:
                raise PlannerError(FixedSamplePaths(self.paths))
            return self._pool
        have = 0 if self._pool is None else len(self._pool.targets)
        while have < count:
            block = self._draw(PATH_BLOCK) if self.sampling == "crn" else self._draw_quasi(have)
            joined = () if self._pool is None else (self._pool,)
            self._pool = Paths(*(np.concatenate(arrays) for arrays in zip(*joined, block, strict=True)))
            have += PATH_BLOCK
        assert self._pool is not None
        return self._pool

    def _draw_quasi(self, first: int) -> Paths:
        if self._shift is None:
            self._shift = self.rng.random(QUASI_DIMENSIONS)
        rules = self.simulation.rules
        return quasi_random_paths(self.belief, rules.sigma, first, PATH_BLOCK, rules.horizon, self._shift, self.rng)

    def _draw(self, count: int) -> Paths:
        rules = self.simulation.rules
        return random_paths(self.belief, rules.sigma, count, rules.horizon, self.rng)


def claim_after(
    problem: Problem, belief: GridBelief, simulation: Simulation, without: Sequence[tuple[float, float]] = ()
) -> ClaimAhead | None:
    """What the next bearing may lead to; None: hardly to a claim, so that rollouts decide.

    without: places (m ENU) that the operator refused.
    """

    def left(places: FloatArray) -> FloatArray:
        allowed = far_enough(problem, simulation.platform, without_refused(places, without, problem, belief))
        return with_own_echoes(allowed, problem)

    return claim_ahead(
        problem,
        belief,
        simulation.platform,
        lambda: left(constrained_actions(problem, belief, left)),
        lambda places: simulation.first_actions(places).costs,
    )


@dataclass(frozen=True, slots=True)
class Rollout:
    """The rollout policy over a finite action space, as a `Policy`.

    budget: N rollouts a decision. With deterministic sampling every action gets the largest power of two of paths
    that the budget affords. base_policy `dynamic_program`: its substitute while no table for it is kept.
    terminal: closes rollouts cut at `horizon`. without: places (m ENU) the operator refused.
    """

    selection: Selection
    sampling: Sampling
    base_policy: BasePolicy
    budget: int
    threads: int = 1
    horizon: int = HORIZON
    kernel: KernelName = "compiled"
    terminal: TerminalValue | None = None
    heading: float | None = None
    without: Sequence[tuple[float, float]] = ()

    def __call__(
        self, problem: Problem, belief: GridBelief, platform: tuple[float, float], rng: np.random.Generator
    ) -> Decision:
        """Raises PlannerError when no place of the action space may be flown to."""
        followed, program = stands_on(problem, self.base_policy)
        simulation = simulate(
            problem,
            belief,
            platform,
            base_policy=followed,
            heading=self.heading,
            horizon=self.horizon if program is None else min(self.horizon, PROGRAM_HORIZON),
            threads=self.threads,
            kernel=self.kernel,
            terminal=self.terminal,
            program=program,
        )
        ahead = claim_after(problem, belief, simulation, self.without)
        if ahead is not None:
            return choice(ahead)
        places = self._places(problem, belief, simulation, program)
        budget, paths = self.budget, 8
        if self.sampling == "deterministic":
            if budget < len(places):
                raise PlannerError(BudgetTooSmall(budget, len(places)))
            paths = 2 ** int(np.log2(budget // len(places)))
            budget = paths * len(places)
        sampler = RolloutSampler(simulation, belief, self.sampling, rng, places, paths)
        result = self._selection(simulation, places, budget)(sampler.sample, len(places), budget, rng)
        decision = _decision(places, result, sampler)
        if program is not None:
            return self._with_times(decision, belief, simulation, program, rng)
        if self.base_policy == "dynamic_program":
            tried = sum(candidate.rollouts > 0 for candidate in decision.candidates)
            expected_time = float(result.means[result.best])
            return replace(decision, reason=PlannedMeanwhile(expected_time, tried))
        return decision

    def _with_times(
        self,
        decision: Decision,
        belief: GridBelief,
        simulation: Simulation,
        program: ProgramTable,
        rng: np.random.Generator,
    ) -> Decision:
        """The times by way of the chosen place, the program followed until the emitter is localized."""
        rules = rules_of(simulation.problem, "dynamic_program", self.horizon, simulation.graph, program)
        to_the_end = replace(simulation, rules=rules)
        paths = random_paths(belief, rules.sigma, FORECAST_PATHS, rules.horizon, rng)
        tasks = Tasks(np.zeros(FORECAST_PATHS, dtype=np.int64), np.arange(FORECAST_PATHS))
        chosen = to_the_end.first_actions(np.array([[decision.x, decision.y]]))
        times = to_the_end.run(chosen, paths, tasks).costs
        return replace(decision, times=times, rollouts=decision.rollouts + FORECAST_PATHS)

    def _selection(self, simulation: Simulation, places: FloatArray, budget: int) -> Selection:
        """With common paths, uniform allocation gives up what loses for sure: no path is shorter than its first leg."""
        if self.selection is not uniform or self.sampling == "pmc" or self.terminal is not None:
            return self.selection
        stride = max(1, budget // len(places) // MOST_LOOKS)
        return partial(uniform, least=simulation.first_actions(places).costs, stride=stride)

    def _places(
        self, problem: Problem, belief: GridBelief, simulation: Simulation, program: ProgramTable | None
    ) -> FloatArray:
        def flown_to(places: FloatArray) -> FloatArray:
            return far_enough(problem, simulation.platform, without_refused(places, self.without, problem, belief))

        def left(places: FloatArray) -> FloatArray:
            return with_own_echoes(flown_to(places), problem)

        def reached(places: FloatArray) -> FloatArray:
            return places[np.isfinite(simulation.first_actions(places).costs)]

        def left_in_reach(places: FloatArray) -> FloatArray:
            return with_own_echoes(reached(flown_to(places)), problem)

        places = left(self._allowed(problem, belief, simulation, program, left))
        if len(places) == 0:
            raise PlannerError(EveryPlaceRefused())
        reachable = reached(places)
        if len(reachable) == 0:  # the ways to all places take a while to find
            reachable = left_in_reach(self._allowed(problem, belief, simulation, program, left_in_reach))
        if len(reachable) == 0:
            raise PlannerError(NoPlaceInReach())
        return telling_places(problem, belief, reachable, TELLING_SHARE)

    def _allowed(
        self,
        problem: Problem,
        belief: GridBelief,
        simulation: Simulation,
        program: ProgramTable | None,
        usable: Usable,
    ) -> FloatArray:
        if program is None:
            return constrained_actions(problem, belief, usable)
        here = (float(simulation.platform[0]), float(simulation.platform[1]))
        return best_places(problem, belief, here, program, PROGRAM_PLACES, usable)[0]


def _decision(places: FloatArray, result: SelectionResult, sampler: RolloutSampler) -> Decision:
    best = result.best
    candidates = tuple(
        Candidate(float(x), float(y), float(mean), float(error), int(count), int(dropped) or None)
        for (x, y), mean, error, count, dropped in zip(
            places, result.means, result.std_errors, result.counts, result.dropped_in_round, strict=True
        )
    )
    return Decision(
        x=float(places[best, 0]),
        y=float(places[best, 1]),
        reason=_reason(result),
        candidates=candidates,
        times=np.concatenate(sampler.seen[best]),
        rollouts=sampler.used,
    )


def _reason(result: SelectionResult) -> ChoiceReason:
    expected_time = float(result.means[result.best])
    others = np.delete(result.means, result.best)
    tried = 1 + int(np.isfinite(others).sum())
    if tried == 1:
        return OnlyPlace(expected_time, "allowed" if len(result.means) == 1 else "tried")
    gain = float(np.nanmin(others)) - expected_time
    return QuickestPlace(expected_time, gain, tried) if gain >= 0.5 else LongestLead(expected_time, tried)
