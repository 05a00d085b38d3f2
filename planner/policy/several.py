"""Policy rollout for several emitters that one turn hears at once: where a bearing shortens all their searches most.

The value of a first action a is the mean over the wanted emitters of each one's own time until localized by way of a,

    V(a) = 1 / E sum_e E[T_e(a)],

each from its own belief by the base policy (planner.policy.rollout); those that are more important weigh more
(planner.policy.importance). The exact objective, the time until the last of
them, needs rollouts that carry all beliefs at once; its lower bound max_e T_e hangs on one unlucky emitter and chose
worse in simulated missions than this sum did (docs/several-emitters.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from planner.belief.coarse import coarser
from planner.belief.estimate import confidence_region, estimate
from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief
from planner.geometry import distance_to_convex
from planner.kernels.model import Actions, Paths, Tasks
from planner.options import BasePolicy, PlannerOptions
from planner.policy.actions import action_space, own_echoes, standoff_from, without_refused
from planner.policy.dynamic_program import stands_on
from planner.policy.fisher import first_best, fisher, gain_beside_bias, information_gain
from planner.policy.importance import mean_time, weights_of
from planner.policy.rollout import MOST_LOOKS, PATH_BLOCK, PROGRAM_HORIZON, SELECTIONS, TELLING_SHARE
from planner.policy.simulation import HORIZON, Simulation, allowed_lattice, simulate
from planner.reasons import (
    BudgetTooSmall,
    ChoiceReason,
    EveryPlaceRefused,
    NoPlaceInReach,
    SoonestForFirst,
    SoonestTogether,
)
from planner.sampling import deterministic_paths, random_paths
from planner.selection.types import Selection, SelectionResult
from planner.selection.uniform import uniform
from planner.travel import straight_suffices
from planner.types import BoolArray, Candidate, Decision, Estimate, FloatArray, IntArray, PlannerError, Problem


@dataclass(frozen=True, slots=True)
class Wanted:
    """An emitter still looked for. problem: the same area to fly in for all of them; sigma and threshold its own. rank:
    the lower, the more important (`planner.policy.importance`); equal ones are alike. name: as a reason calls it."""

    problem: Problem
    belief: GridBelief
    rank: int = 0
    name: str = ""


FEW_CELLS = 48
"""Cells along the longer axis that rollouts start with: fewer than single plans do, since every emitter has its own."""

FEW_PLACES = 120
"""How many of the lattice's places, roughly, the base policy chooses from in rollouts."""

FORECAST_PATHS = 32
"""Of each emitter, followed to their end for the times left where the choice closed them early."""


@dataclass(slots=True)
class _Member:
    """One emitter's rollouts. detour: its Fisher place, flown to after a place that tells nothing of it. near: m, from
    within which a bearing is taken to tell nothing. telling: (a,) which places tell anything beside what the bearings
    have in common. without: (p,) s, what each path costs from the detour on, NaN while nobody asked. used: rollouts."""

    belief: GridBelief
    simulation: Simulation
    actions: Actions
    detour: Actions
    near: float
    rng: np.random.Generator
    paths: Paths
    telling: BoolArray
    without: FloatArray = field(default_factory=lambda: np.empty(0))
    used: int = 0

    def costs(self, chosen: IntArray, path_from: int, path_to: int) -> FloatArray:
        """(k, path_to - path_from) s until this emitter is localized.

        From a place that repeats the sensor's bias, and on a path whose target lies too near to the place, the bearing
        tells nothing: the cost is that of the place, and then of the search without it.
        """
        self._reach(path_to)
        path = np.arange(path_from, path_to)
        way = self.actions.places[chosen][:, None, :] - self.paths.targets[path][None, :, :]
        telling = self.telling[chosen][:, None] & (np.hypot(way[..., 0], way[..., 1]) >= self.near)
        costs = np.empty(telling.shape)
        row, column = np.nonzero(telling)
        costs[telling] = self._run(self.actions, chosen[row], path[column])
        row, column = np.nonzero(~telling)
        costs[~telling] = self.actions.costs[chosen[row]] + self._without(path[column])
        return costs

    def _run(self, actions: Actions, chosen: IntArray, path: IntArray) -> FloatArray:
        """(n,) s of the rollouts of first actions `chosen` (n,) on the paths (n,)."""
        if len(chosen) == 0:
            return np.empty(0)
        self.used += len(chosen)
        return self.simulation.run(actions, self.paths, Tasks(chosen.astype(np.int64), path)).costs

    def _without(self, path: IntArray) -> FloatArray:
        """(n,) s from the detour on, of the paths (n,); every path is run once."""
        asked = np.unique(path[np.isnan(self.without[path])])
        self.without[asked] = self._run(self.detour, np.zeros(len(asked), dtype=np.int64), asked)
        return self.without[path]

    def _reach(self, count: int) -> None:
        """More paths, drawn in blocks so that path j is the same for every action."""
        rules = self.simulation.rules
        while len(self.paths.targets) < count:
            drawn = random_paths(self.belief, rules.sigma, PATH_BLOCK, rules.horizon, self.rng)
            self.paths = Paths(*(np.concatenate(arrays) for arrays in zip(self.paths, drawn, strict=True)))
        missing = len(self.paths.targets) - len(self.without)
        self.without = np.concatenate([self.without, np.full(missing, np.nan)])

    def to_the_end(self) -> _Member:
        """The same emitter with rollouts that are not closed early, on paths of their own."""
        simulation = replace(self.simulation, rules=self.simulation.rules._replace(horizon=HORIZON))
        return replace(self, simulation=simulation, paths=_no_paths(HORIZON), without=np.empty(0), used=0)


@dataclass(slots=True)
class _Together:
    """The `Sample` over all members: one path is a path of each of them. weights: (E,), None of members that are alike.
    each: of each action, blocks (E, paths) of the members' times."""

    members: Sequence[_Member]
    pool: ThreadPoolExecutor
    weights: FloatArray | None
    each: dict[int, list[FloatArray]] = field(default_factory=dict[int, list[FloatArray]])

    @property
    def used(self) -> int:
        """Rollouts so far."""
        return sum(member.used for member in self.members)

    def sample(self, actions: IntArray, path_from: int, path_to: int) -> FloatArray:
        """(k, path_to - path_from) s: the mean time of the members, weighed by their importance."""
        chosen = np.asarray(actions, dtype=np.int64)

        def of(member: _Member) -> FloatArray:
            return member.costs(chosen, path_from, path_to)

        costs = np.stack(list(self.pool.map(of, self.members)))
        for row, index in enumerate(chosen):
            self.each.setdefault(int(index), []).append(costs[:, row])
        return mean_time(costs, self.weights)

    def times(self, action: int) -> FloatArray:
        """(E, paths) s of every member by way of the action."""
        return np.concatenate(self.each[action], axis=1)


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
    copies = [replace(one, belief=coarser(one.belief, FEW_CELLS)) for one in wanted]
    following = _following(wanted[0].problem)
    simulations = [_simulation(one, platform, options.base_policy, following, PROGRAM_HORIZON) for one in copies]
    places = _places(wanted, simulations[0], without)
    estimates = [estimate(one.belief, one.problem.estimator) for one in copies]
    gains = np.stack([_gains(one, spread, places) for one, spread in zip(wanted, estimates, strict=True)])
    telling = np.stack([_telling(one, gain, places) for one, gain in zip(wanted, gains, strict=True)])
    # what tells nothing of any of them is no next place, however soon it is reached
    some = telling.any(axis=0)
    places, gains, telling = places[some], gains[:, some], telling[:, some]
    chances = np.random.default_rng([options.seed, *(w.belief.bearings for w in wanted)]).spawn(len(wanted))
    budget, count = paths_among(options.budget, len(wanted)), 0
    if options.sampling == "deterministic":
        if budget < len(places):
            raise PlannerError(BudgetTooSmall(budget, len(places)))
        count = 2 ** int(np.log2(budget // len(places)))
        budget = count * len(places)
    near = standoff_among(wanted[0].problem, len(places), len(wanted))
    weights = weights_of([one.rank for one in wanted])
    members = [
        _member(one, simulation, places, _detour(one, gain, places), rng, count, near, tells)
        for one, simulation, gain, rng, tells in zip(copies, simulations, gains, chances, telling, strict=True)
    ]
    with ThreadPoolExecutor(threads) as pool:
        together = _Together(members, pool, weights)
        least = members[0].actions.costs
        result = _selection(options, budget, least)(together.sample, len(places), budget, chances[0])
        last = together
        if any(simulation.rules.horizon < HORIZON for simulation in simulations):
            last = _Together([member.to_the_end() for member in members], pool, weights)
            last.sample(np.array([result.best]), 0, FORECAST_PATHS)
    rollouts = together.used + (0 if last is together else last.used)
    return _decision(places, result, wanted, last.times(result.best), rollouts)


def times_together(
    wanted: Sequence[Wanted],
    platform: tuple[float, float],
    places: FloatArray,
    options: PlannerOptions,
    paths: int,
) -> FloatArray:
    """(k, paths) s: the emitters' mean time, weighed by their importance, by way of each of the places (k, 2), m, on
    the same sample paths.

    infinite by way of a place without a way to it.
    """
    simulations = [_simulation(one, platform, options.base_policy, None, HORIZON) for one in wanted]
    allowed = _places(wanted, simulations[0], ())
    beside = np.vstack([places, allowed])
    chances = np.random.default_rng([options.seed, *(w.belief.bearings for w in wanted)]).spawn(len(wanted))
    near = standoff_among(wanted[0].problem, len(allowed), len(wanted))
    members: list[_Member] = []
    for one, simulation, rng in zip(wanted, simulations, chances, strict=True):
        choice = fisher(one.problem, one.belief, platform)
        # beside all that the planner compares: of two places that tell little, neither is one that tells much
        telling = telling_beside_bias(one.problem, one.belief, beside)[: len(places)]
        members.append(_member(one, simulation, places, (choice.x, choice.y), rng, 0, near, telling))
    chosen = np.arange(len(places))
    costs = np.stack([member.costs(chosen, 0, paths) for member in members])
    return mean_time(costs, weights_of([one.rank for one in wanted]))


def _following(problem: Problem) -> FloatArray | None:
    """(n, 2) m: every k-th column and row of the lattice that may be flown to; None: all of it, since it is small or
    ways lead around something."""
    places = allowed_lattice(problem)
    if len(places) <= FEW_PLACES or not straight_suffices(problem):
        return None
    every = int(np.ceil(np.sqrt(len(places) / FEW_PLACES)))
    row_and_column = np.rint((places - places.min(axis=0)) / problem.action_spacing).astype(np.int64)
    kept = places[(row_and_column % every == every // 2).all(axis=1)]
    return np.ascontiguousarray(kept) if len(kept) >= 2 else None


def _simulation(
    wanted: Wanted, platform: tuple[float, float], base_policy: BasePolicy, following: FloatArray | None, horizon: int
) -> Simulation:
    """Rollouts of `horizon` bearings where the program's table closes them, else to their end."""
    followed, program = stands_on(wanted.problem, base_policy)
    horizon = HORIZON if program is None else horizon
    return simulate(
        wanted.problem,
        wanted.belief,
        platform,
        base_policy=followed,
        horizon=horizon,
        program=program,
        places=following,
    )


def _no_paths(horizon: int) -> Paths:
    return Paths(np.empty((0, 2)), np.empty((0, horizon)))


def _member(
    wanted: Wanted,
    simulation: Simulation,
    places: FloatArray,
    detour_to: tuple[float, float],
    rng: np.random.Generator,
    deterministic: int,
    near: float,
    telling: BoolArray,
) -> _Member:
    """deterministic: how many equal-mass paths there are, 0 for random ones."""
    detour = simulation.first_actions(np.array([detour_to]))
    horizon = simulation.rules.horizon
    paths = deterministic_paths(wanted.belief, deterministic, horizon) if deterministic else _no_paths(horizon)
    return _Member(wanted.belief, simulation, simulation.first_actions(places), detour, near, rng, paths, telling)


def telling_beside_bias(problem: Problem, belief: GridBelief, places: FloatArray) -> BoolArray:
    """(n,) which places (n, 2) tell the bias of the bearings from the place of the emitter.

    Rollouts take the bearings to come as independent, so that a craft which stays where it is would seem to halve an
    error that it only measures again, or the same echoes. The bias is that of the source with the most bearings.
    """
    wanted = Wanted(problem, belief)
    return _telling(wanted, _gains(wanted, estimate(belief, problem.estimator), places), places)


def _gains(wanted: Wanted, estimated: Estimate, places: FloatArray) -> FloatArray:
    """(n,) by how much each place shrinks this emitter's uncertainty, an uncertain bias counted in."""
    belief = wanted.belief
    if not isinstance(belief, JointBelief) or not belief.errors:
        return information_gain(estimated, places, nearest=belief.h)
    errors = max(belief.errors, key=lambda one: one.bearings)
    return gain_beside_bias(estimated, places, errors, wanted.problem.sigma, nearest=belief.h)


def _telling(wanted: Wanted, gains: FloatArray, places: FloatArray) -> BoolArray:
    problem, telling = wanted.problem, own_echoes(places, wanted.problem)
    if problem.crossing is not None:
        telling[telling] = problem.crossing.crossed_from(places[telling])
    if not isinstance(wanted.belief, JointBelief) or not wanted.belief.errors:
        return telling
    return np.asarray(telling & (gains >= TELLING_SHARE * gains[telling].max()))


def _detour(wanted: Wanted, gains: FloatArray, places: FloatArray) -> tuple[float, float]:
    """Of the places (n, 2) of these gains (n,) with echoes of their own, the best one r_min off its C95 (6.1)."""
    own = own_echoes(places, wanted.problem)
    places, gains = places[own], gains[own]
    clearance = distance_to_convex(places, confidence_region(wanted.belief))
    standoff = standoff_from(wanted.belief, wanted.problem)
    far = clearance >= min(standoff, float(np.sort(clearance)[-min(2, len(clearance))]))
    x, y = places[first_best(np.where(far, gains, 0.0))].tolist()
    return x, y


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
    """(n, 2) m: wherever the platform may measure and can get to. Echoes are each emitter's own (`_telling`)."""
    problem, belief = wanted[0].problem, wanted[0].belief
    places = without_refused(action_space(problem, belief), without, problem, belief)
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


def _decision(
    places: FloatArray, result: SelectionResult, wanted: Sequence[Wanted], each: FloatArray, rollouts: int
) -> Decision:
    """each: (E, paths) s of every emitter by way of the best place."""
    best = result.best
    tried = int(np.isfinite(result.means).sum())
    candidates = tuple(
        Candidate(float(x), float(y), float(mean), float(error), int(count), int(dropped) or None)
        for (x, y), mean, error, count, dropped in zip(
            places, result.means, result.std_errors, result.counts, result.dropped_in_round, strict=True
        )
    )
    reason: ChoiceReason = SoonestTogether(float(result.means[best]), len(each), tried)
    ranks = np.array([one.rank for one in wanted])
    first = ranks == ranks.min()
    if not first.all():
        names = tuple(one.name for one in wanted if one.rank == ranks.min())
        reason = SoonestForFirst(names, float(each[first].mean()), int((~first).sum()), tried)
    return Decision(
        x=float(places[best, 0]),
        y=float(places[best, 1]),
        reason=reason,
        candidates=candidates,
        times=each.max(axis=0),
        each=each,
        rollouts=rollouts,
    )
