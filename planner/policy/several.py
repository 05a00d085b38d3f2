"""Policy rollout for several emitters that one turn hears at once: where a bearing shortens all their searches most.

The value of a first action a is the mean over the wanted emitters of each one's own time until localized by way of a,

    V(a) = 1 / E sum_e E[T_e(a)],

each from its own belief by the base policy (planner.policy.rollout). The exact objective, the time until the last of
them, needs rollouts that carry all beliefs at once; its lower bound max_e T_e hangs on one unlucky emitter and chose
worse in simulated missions than this sum did (docs/several-emitters.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from planner.belief.estimate import estimate
from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief
from planner.kernels.model import Actions, Paths, Tasks
from planner.options import BasePolicy, PlannerOptions
from planner.policy.actions import action_space
from planner.policy.dynamic_program import stands_on
from planner.policy.fisher import fisher, gain_beside_bias
from planner.policy.rollout import MOST_LOOKS, PATH_BLOCK, SELECTIONS, TELLING_SHARE
from planner.policy.simulation import Simulation, simulate
from planner.reasons import BudgetTooSmall, EveryPlaceRefused, NoPlaceInReach, SoonestTogether
from planner.sampling import deterministic_paths, random_paths
from planner.selection.types import Selection, SelectionResult
from planner.selection.uniform import uniform
from planner.types import BoolArray, Candidate, Decision, FloatArray, IntArray, PlannerError, Problem


@dataclass(frozen=True, slots=True)
class Wanted:
    """An emitter still looked for. problem: the same area to fly in for all of them; sigma and threshold its own."""

    problem: Problem
    belief: GridBelief


@dataclass(slots=True)
class _Member:
    """One emitter's rollouts. detour: its Fisher place, flown to after a place that tells nothing of it. near: m, from
    within which a bearing is taken to tell nothing. telling: (a,) which places tell anything beside what the bearings
    have in common."""

    wanted: Wanted
    simulation: Simulation
    actions: Actions
    detour: Actions
    near: float
    rng: np.random.Generator
    paths: Paths
    telling: BoolArray
    without: FloatArray = field(default_factory=lambda: np.empty(0))

    def costs(self, chosen: IntArray, path_from: int, path_to: int) -> FloatArray:
        """(k, path_to - path_from) s until this emitter is localized.

        From a place that repeats the sensor's bias, and on a path whose target lies too near to the place, the bearing
        tells nothing: the cost is that of the place, and then of the search without it.
        """
        self._reach(path_to)
        count = path_to - path_from
        path = np.arange(path_from, path_to)
        tasks = Tasks(np.repeat(chosen, count), np.tile(path, len(chosen)))
        costs = self.simulation.run(self.actions, self.paths, tasks).costs.reshape(len(chosen), count)
        way = self.actions.places[chosen][:, None, :] - self.paths.targets[path][None, :, :]
        near = np.hypot(way[..., 0], way[..., 1]) < self.near
        wasted = self.actions.costs[chosen][:, None] + self.without[path][None, :]
        return np.where(near | ~self.telling[chosen][:, None], wasted, costs)

    def _reach(self, count: int) -> None:
        """Paths and what they cost without the first place, so that path j is the same for every action."""
        rules = self.simulation.rules
        while len(self.paths.targets) < count:
            drawn = random_paths(self.wanted.belief, rules.sigma, PATH_BLOCK, rules.horizon, self.rng)
            self.paths = Paths(*(np.concatenate(arrays) for arrays in zip(self.paths, drawn, strict=True)))
        have = len(self.without)
        if have < len(self.paths.targets):
            added = np.arange(have, len(self.paths.targets))
            tasks = Tasks(np.zeros(len(added), dtype=np.int64), added)
            more = self.simulation.run(self.detour, self.paths, tasks).costs
            self.without = np.concatenate([self.without, more])


@dataclass(slots=True)
class _Together:
    """The `Sample` over all members: one path is a path of each of them. last: of each path, of the last one found."""

    members: Sequence[_Member]
    pool: ThreadPoolExecutor
    used: int = 0
    last: dict[int, list[FloatArray]] = field(default_factory=dict[int, list[FloatArray]])

    def sample(self, actions: IntArray, path_from: int, path_to: int) -> FloatArray:
        """(k, path_to - path_from) s: the mean time of the members."""
        chosen = np.asarray(actions, dtype=np.int64)

        def of(member: _Member) -> FloatArray:
            return member.costs(chosen, path_from, path_to)

        costs = np.stack(list(self.pool.map(of, self.members)))
        self.used += costs.size
        for index, row in zip(chosen, costs.max(axis=0), strict=True):
            self.last.setdefault(int(index), []).append(row)
        return costs.mean(axis=0)


def plan_several(
    wanted: Sequence[Wanted],
    platform: tuple[float, float],
    options: PlannerOptions,
    *,
    threads: int = 2,
    without: Sequence[tuple[float, float]] = (),
) -> Decision:
    """The next place to measure from (m ENU), for all the wanted emitters at once.

    options: every one of the sample paths (`paths_among`) is a rollout of each emitter; independent paths (`pmc`) are
    drawn as common ones. without: places that the operator refused. times: until the last one is localized if each is
    flown for by itself from the place on, which is a lower bound. Raises PlannerError when no place is allowed or
    reachable.
    """
    simulations = [_simulation(one, platform, options.base_policy) for one in wanted]
    places = _places(wanted, simulations[0], without)
    # what tells nothing of any of them is no next place, however soon it is reached
    places = places[np.any([telling_beside_bias(one.problem, one.belief, places) for one in wanted], axis=0)]
    chances = np.random.default_rng([options.seed, *(w.belief.bearings for w in wanted)]).spawn(len(wanted))
    budget, count = paths_among(options.budget, len(wanted)), 0
    if options.sampling == "deterministic":
        if budget < len(places):
            raise PlannerError(BudgetTooSmall(budget, len(places)))
        count = 2 ** int(np.log2(budget // len(places)))
        budget = count * len(places)
    members = [
        _member(one, simulation, places, platform, rng, count, standoff_among(one.problem, len(places), len(wanted)))
        for one, simulation, rng in zip(wanted, simulations, chances, strict=True)
    ]
    with ThreadPoolExecutor(threads) as pool:
        together = _Together(members, pool)
        least = members[0].actions.costs
        result = _selection(options, budget, least)(together.sample, len(places), budget, chances[0])
    return _decision(places, result, together)


def times_together(
    wanted: Sequence[Wanted],
    platform: tuple[float, float],
    places: FloatArray,
    options: PlannerOptions,
    paths: int,
) -> FloatArray:
    """(k, paths) s: the mean of the emitters' times by way of each of the places (k, 2), m, on the same sample paths.

    infinite by way of a place without a way to it.
    """
    simulations = [_simulation(one, platform, options.base_policy) for one in wanted]
    allowed = len(_places(wanted, simulations[0], ()))
    chances = np.random.default_rng([options.seed, *(w.belief.bearings for w in wanted)]).spawn(len(wanted))
    members = [
        _member(one, simulation, places, platform, rng, 0, standoff_among(one.problem, allowed, len(wanted)))
        for one, simulation, rng in zip(wanted, simulations, chances, strict=True)
    ]
    chosen = np.arange(len(places))
    return np.stack([member.costs(chosen, 0, paths) for member in members]).mean(axis=0)


def _simulation(wanted: Wanted, platform: tuple[float, float], base_policy: BasePolicy) -> Simulation:
    """Rollouts to the end: how long the last of them takes is not known from a program's mean values."""
    followed, program = stands_on(wanted.problem, base_policy)
    return simulate(wanted.problem, wanted.belief, platform, base_policy=followed, program=program)


def _member(
    wanted: Wanted,
    simulation: Simulation,
    places: FloatArray,
    platform: tuple[float, float],
    rng: np.random.Generator,
    deterministic: int,
    near: float,
) -> _Member:
    """deterministic: how many equal-mass paths there are, 0 for random ones."""
    choice = fisher(wanted.problem, wanted.belief, platform)
    detour = simulation.first_actions(np.array([[choice.x, choice.y]]))
    horizon = simulation.rules.horizon
    none = Paths(np.empty((0, 2)), np.empty((0, horizon)))
    paths = deterministic_paths(wanted.belief, deterministic, horizon) if deterministic else none
    telling = telling_beside_bias(wanted.problem, wanted.belief, places)
    return _Member(wanted, simulation, simulation.first_actions(places), detour, near, rng, paths, telling)


def telling_beside_bias(problem: Problem, belief: GridBelief, places: FloatArray) -> BoolArray:
    """(n,) which places (n, 2) tell the bias of the bearings from the place of the emitter.

    Rollouts take the bearings to come as independent, so that a craft which stays where it is would seem to halve an
    error that it only measures again. The bias is that of the source with the most bearings.
    """
    if not isinstance(belief, JointBelief) or not belief.errors:
        return np.ones(len(places), dtype=bool)
    errors = max(belief.errors, key=lambda one: one.bearings)
    estimated = estimate(belief, problem.estimator)
    gains = gain_beside_bias(estimated, places, errors, problem.sigma, nearest=belief.h)
    return np.asarray(gains >= TELLING_SHARE * gains.max())


FEWEST_PATHS = 250
"""Fewer are not shared out among a hundred places."""


def paths_among(budget: int, emitters: int) -> int:
    """How many sample paths of `budget` N are worth their time among E emitters.

    The mean of E emitters' times has a variance of s^2 / (N' E) after N' paths: with N' = N / sqrt(E) the values are
    still better known than those of one emitter after N.
    """
    return max(round(budget / np.sqrt(emitters)), min(budget, FEWEST_PATHS))


def standoff_among(problem: Problem, places: int, emitters: int) -> float:
    """r_min, m, or as much of it as there is room for: circles of r around E emitters cover at most half of the places.

    E pi r^2 <= places spacing^2 / 2; as for one emitter (6.1) r_min shrinks where nothing would be left of the area.
    """
    if problem.action_spacing is None:
        return problem.standoff
    return float(min(problem.standoff, np.sqrt(0.5 * places * problem.action_spacing**2 / (np.pi * emitters))))


def _places(wanted: Sequence[Wanted], simulation: Simulation, without: Sequence[tuple[float, float]]) -> FloatArray:
    """(n, 2) m: wherever the platform may measure and can get to."""
    problem, belief = wanted[0].problem, wanted[0].belief
    places = action_space(problem, belief)
    near = problem.action_spacing or belief.h
    for refused in without:
        places = places[np.hypot(*(places - np.array(refused)).T) >= 0.5 * near]
    if len(places) == 0:
        raise PlannerError(EveryPlaceRefused())
    reachable = np.isfinite(simulation.first_actions(places).costs)
    if not reachable.any():
        raise PlannerError(NoPlaceInReach())
    return places[reachable]


def _selection(options: PlannerOptions, budget: int, least: FloatArray) -> Selection:
    selection = SELECTIONS[options.selection]
    if selection is not uniform:
        return selection
    return partial(uniform, least=least, stride=max(1, budget // len(least) // MOST_LOOKS))


def _decision(places: FloatArray, result: SelectionResult, together: _Together) -> Decision:
    best = result.best
    tried = int(np.isfinite(result.means).sum())
    times = np.concatenate(together.last[best])
    candidates = tuple(
        Candidate(float(x), float(y), float(mean), float(error), int(count), int(dropped) or None)
        for (x, y), mean, error, count, dropped in zip(
            places, result.means, result.std_errors, result.counts, result.dropped_in_round, strict=True
        )
    )
    reason = SoonestTogether(float(result.means[best]), len(together.members), tried)
    return Decision(
        x=float(places[best, 0]),
        y=float(places[best, 1]),
        reason=reason,
        candidates=candidates,
        times=times,
        rollouts=together.used,
    )
