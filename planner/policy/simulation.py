"""Runs rollouts for one decision: turns a problem and a belief into kernel arrays and kernel arrays into costs.

The arrays and the arithmetic are the kernels' (planner.kernels); here is who flies from where, and two threads.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from planner.airspace import may_fly
from planner.belief.coarse import coarser
from planner.belief.grid import FIRST_CELLS, GridBelief
from planner.directions import turning_lead
from planner.kernels import compiled, reference
from planner.kernels.model import (
    DYNAMIC_PROGRAM,
    ELLIPSE,
    EXPECTED_VALUE,
    FISHER,
    FULL,
    GEOMETRIC_MEDIAN,
    LINEAR,
    MAP,
    WIDEST_SIGMA,
    Actions,
    Outcomes,
    Paths,
    Rules,
    Start,
    Tasks,
    likelihood_polynomial,
    outcomes,
)
from planner.kernels.value.model import nodes
from planner.legs import first_time
from planner.motion import flight_time, turn_between, validate_motion
from planner.observation import THINNEST
from planner.options import BasePolicy
from planner.policy.actions import flight_window, lattice
from planner.policy.ellipse import table
from planner.policy.value_table import ProgramTable
from planner.reasons import UnusableNumber
from planner.threads import in_parts
from planner.travel import VisibilityGraph, lattice_distances, straight_suffices, travel_distances, visibility_graph
from planner.types import FloatArray, FullMotion, IntArray, LinearConstantMotion, LinearMotion, PlannerError, Problem

KernelName = Literal["compiled", "reference"]
TerminalValue = Callable[[FloatArray], FloatArray]
"""Time still needed, (t,) s, from the ends (t, 10) of rollouts that were cut; columns as CLOSED_FEATURES."""

LIGHT = 1e-6
"""Rollouts start without the ends of rows that are lighter than this share of the heaviest cell."""

HORIZON = 24
"""Bearings after which a rollout is given up."""

_NO_TABLE = np.empty((0, 0, 0))

UNKNOWN_TURN = np.pi / 2
"""Turn before the first flight when the heading is not known: the mean of all."""


@dataclass(frozen=True, slots=True)
class Simulation:
    """Shared by the rollouts of one decision. platform: (2,) m. heading: rad or None. terminal: closes cut ones.
    belief: for what a turn takes at each place, None: as long everywhere."""

    problem: Problem
    start: Start
    rules: Rules
    platform: FloatArray
    heading: float | None
    graph: VisibilityGraph | None
    threads: int = 1
    kernel: KernelName = "compiled"
    terminal: TerminalValue | None = None
    belief: GridBelief | None = None

    def first_actions(self, places: FloatArray) -> Actions:
        """(a, 2) m places as first actions: cost of flying there and measuring once (4.5); infinite without a way."""
        places = np.ascontiguousarray(places, dtype=float).reshape(-1, 2)
        flights = places - self.platform
        if self.problem.ways is not None:
            distances = self.problem.ways.to(places)
        elif self.graph is None:
            distances = np.hypot(*flights.T)
        else:
            distances = travel_distances(self.problem, self.graph, self.platform, places)
        directions = np.arctan2(flights[:, 1], flights[:, 0])
        turns = UNKNOWN_TURN if self.heading is None else turn_between(self.heading, directions)
        costs = flight_time(self.problem.motion, distances, turns) + first_time(self.problem)
        rule = self.problem.sector_turns
        if rule is not None and self.belief is not None:
            costs = costs + turning_lead(rule, self.belief, places, self.problem.sigma)
        return Actions(places, costs, directions, self._in_lattice(places))

    def _in_lattice(self, places: FloatArray) -> IntArray:
        if len(self.rules.travel) == 0:
            return np.full(len(places), -1, dtype=np.int64)
        index = {(float(x), float(y)): k for k, (x, y) in enumerate(self.rules.places)}
        return np.array([index.get((float(x), float(y)), -1) for x, y in places], dtype=np.int64)

    def run(self, actions: Actions, paths: Paths, tasks: Tasks) -> Outcomes:
        """Outcomes of all tasks, cut rollouts closed by the terminal value; tasks are shared out to the threads."""
        out = outcomes(len(tasks.action))
        kernel = compiled.rollouts if self.kernel == "compiled" else reference.rollouts
        parts = min(self.threads, len(tasks.action) // 8)
        shared = (self.start, self.rules, actions, paths)
        in_parts(len(tasks.action), parts, lambda part: kernel(*shared, tasks.part(part), out.part(part)))
        if self.terminal is not None:
            cut = out.ends[:, 9] == 0.0
            out.costs[cut] += self.terminal(out.ends[cut])
        return out


def simulate(
    problem: Problem,
    belief: GridBelief,
    platform: tuple[float, float],
    *,
    base_policy: BasePolicy,
    heading: float | None = None,
    horizon: int = HORIZON,
    threads: int = 1,
    kernel: KernelName = "compiled",
    terminal: TerminalValue | None = None,
    program: ProgramTable | None = None,
    places: FloatArray | None = None,
) -> Simulation:
    """Prepare rollouts from this belief. PlannerError for numbers that cannot be flown or measured with.

    program: the dynamic program's table, for the base policy of this name only. places: (n, 2) m, those of the lattice
    that the base policy chooses among; None: all of them, as it must be where ways lead around something.
    """
    here = np.array(platform, dtype=float)
    if here.shape != (2,) or not np.isfinite(here).all():
        raise PlannerError(UnusableNumber("platform_position", "finite", str(platform)))
    if horizon < 1:
        raise PlannerError(UnusableNumber("horizon", "at_least_one", str(horizon)))
    if threads < 1:
        raise PlannerError(UnusableNumber("threads", "at_least_one", str(threads)))
    is_straight = problem.ways is not None or straight_suffices(problem)
    graph = None if is_straight else visibility_graph(problem)
    started = coarser(belief, FIRST_CELLS) if problem.likelihood == "resolved" else belief
    return Simulation(
        problem,
        start_of(started),
        rules_of(problem, base_policy, horizon, graph, program, places),
        here,
        heading,
        graph,
        threads,
        kernel,
        terminal,
        belief,
    )


def start_of(belief: GridBelief) -> Start:
    """The belief as kernel arrays, each row cut to the columns that carry weight."""
    live = belief.density >= LIGHT * belief.density.max()
    low = np.where(live.any(axis=1), live.argmax(axis=1), 0)
    high = np.where(live.any(axis=1), belief.nx - live[:, ::-1].argmax(axis=1), 0)
    return Start(
        np.ascontiguousarray(belief.density),
        low.astype(np.int64),
        high.astype(np.int64),
        float(belief.x0),
        float(belief.y0),
        float(belief.h),
        np.ascontiguousarray(belief.hull()),
        int(belief.bearings),
        bool(belief.flat_prior),
    )


def rules_of(
    problem: Problem,
    base_policy: BasePolicy,
    horizon: int,
    graph: VisibilityGraph | None = None,
    program: ProgramTable | None = None,
    places: FloatArray | None = None,
) -> Rules:
    """The problem as kernel numbers; places as in `simulate`. ValueError for the dynamic program without its table."""
    if base_policy == "dynamic_program" and program is None:
        raise ValueError("rollouts on the dynamic program need its table")
    _validate_numbers(problem)
    validate_motion(problem.motion)
    sigma = float(min(problem.sigma, WIDEST_SIGMA))
    coefficients, edge = likelihood_polynomial(sigma)
    if places is None:
        places = allowed_lattice(problem)
    travel = np.empty((0, 0))
    if problem.ways is not None:
        travel = np.ascontiguousarray(problem.ways.between(places))
    elif graph is not None and len(places) > 0:
        travel = np.ascontiguousarray(lattice_distances(problem, places))
    ratios, distances = table(problem.sigma)
    motion, speed, constant, turn_rate, acceleration = _motion_numbers(problem)
    return Rules(
        sigma=sigma,
        likelihood=coefficients,
        edge=edge,
        blur=(THINNEST / sigma) ** 2 if problem.likelihood == "resolved" else 0.0,
        threshold=float(problem.threshold),
        measurement_time=float(problem.measurement_time),
        motion=motion,
        speed=speed,
        constant=constant,
        turn_rate=turn_rate,
        acceleration=acceleration,
        estimator={"map": MAP, "expected_value": EXPECTED_VALUE, "geometric_median": GEOMETRIC_MEDIAN}[
            problem.estimator
        ],
        policy={"ellipse": ELLIPSE, "fisher": FISHER, "dynamic_program": DYNAMIC_PROGRAM}[base_policy],
        standoff=float(problem.standoff),
        places=places,
        travel=travel,
        grid_x=int(problem.action_grid[0]),
        grid_y=int(problem.action_grid[1]),
        window=flight_window(problem),
        ratios=ratios,
        distances=distances,
        horizon=int(horizon),
        after=_NO_TABLE if program is None else program.adapted(problem),
        nodes=nodes(),
    )


def allowed_lattice(problem: Problem) -> FloatArray:
    """(n, 2) m: the places of the lattice that may be flown to; none when actions are no lattice."""
    if problem.action_spacing is None and problem.ways is None:
        return np.empty((0, 2))
    places = lattice(problem)
    return np.ascontiguousarray(places[may_fly(problem, places)])


def _validate_numbers(problem: Problem) -> None:
    if not (np.isfinite(problem.sigma) and problem.sigma > 0):
        raise PlannerError(UnusableNumber("sigma", "positive", f"{problem.sigma:g}"))
    if not (np.isfinite(problem.threshold) and problem.threshold > 0):
        raise PlannerError(UnusableNumber("threshold", "positive", f"{problem.threshold:g}"))
    if not (np.isfinite(problem.measurement_time) and problem.measurement_time >= 0):
        raise PlannerError(UnusableNumber("measurement_time", "not_negative", f"{problem.measurement_time:g}"))


def _motion_numbers(problem: Problem) -> tuple[int, float, float, float, float]:
    match problem.motion:
        case LinearMotion(speed):
            return LINEAR, float(speed), 0.0, 1.0, 1.0
        case LinearConstantMotion(speed, constant):
            return LINEAR, float(speed), float(constant), 1.0, 1.0
        case FullMotion(turn_rate, acceleration, speed, constant):
            return FULL, float(speed), float(constant), float(turn_rate), float(acceleration)
