"""Tables of the Gaussian dynamic program: for which problem, how they are computed, and which are at hand.

V(b, p) = min_a t(p, a) + G(b, a),   G(b, a) = t_m + E_z V(b', a) where b' is not yet localized (Bellman's equation of
4.5 and 4.11 for a belief that is a Gaussian after every bearing). Lengths are in units of the threshold inside.

A table takes ten seconds or more of one processor (planner.study.value_cache keeps it on disk); those of the suggested
mission come with the package (SHIPPED). Plans use it and those that are kept in memory (`keep`); while none fits,
`program_for` answers None and another base policy stands in.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from itertools import product
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from planner.kernels.model import WIDEST_SIGMA
from planner.kernels.value.iteration import iterate
from planner.kernels.value.model import DRAWS, NODES, RATIOS, Transitions, nodes, ratios, scales
from planner.kernels.value.transitions import transitions
from planner.sampling import normal_quantile, sobol
from planner.types import FloatArray, FullMotion, LinearConstantMotion, LinearMotion, Motion, Problem

MEAN_TURN = math.pi / 2
SWEEPS = 400
TOLERANCE = 1e-2
"""Value iteration ends after SWEEPS, or when a sweep changes no value by TOLERANCE of a bearing's time."""

SIGMA_FACTOR, TIME_FACTOR = 2.0, 3.0
"""A table also serves problems whose sigma and measuring time are within these factors of its own: what a mission finds
of its sensor, a joint belief's uncertain bias included, moves sigma as far."""

SHIPPED = Path(__file__).with_name("shipped_table.npz")
STEP = 1.0 / 32.0
"""s, what the shipped tables are rounded to; 16 bits of it reach 34 minutes."""
SHIPPED_SIGMAS_DEG = (3, 7, 12)
"""What a mission starts with, and what a sensor turns out to be: a compass that is known to be right, or not known."""
SHIPPED_TIMES_S = (16, 30)
"""Of a bearing: the suggested mission's, and the fielded system's."""


@dataclass(frozen=True, slots=True)
class ProgramKey:
    """What decides a table. sigma: rad. threshold, standoff: m. measurement_time: s."""

    sigma: float
    threshold: float
    measurement_time: float
    motion: Motion
    standoff: float

    @property
    def name(self) -> str:
        """For a file: equal for equal keys only."""
        parts = [type(self.motion).__name__, *self.numbers()]
        return "-".join(part if isinstance(part, str) else f"{part:.9g}" for part in parts)

    def numbers(self) -> tuple[float, ...]:
        """All numbers of the key, in a fixed order."""
        full, speed, constant, acceleration = motion_numbers(self.motion)
        own = (self.sigma, self.threshold, self.measurement_time, self.standoff)
        return *own, float(full), speed, constant, acceleration


@dataclass(frozen=True, slots=True, eq=False)
class ProgramTable:
    """after: (SCALES, RATIOS, NODES^2) s, G; float32 numbers as float64, so that kept and fresh tables are equal."""

    key: ProgramKey
    after: FloatArray

    def adapted(self, problem: Problem) -> FloatArray:
        """G with the problem's own measuring time for the first bearing; not to be written to."""
        return _adapted(self, problem.measurement_time)


@lru_cache(8)
def _adapted(table: ProgramTable, measurement_time: float) -> FloatArray:
    """A plan for several emitters asks once for each."""
    return table.after + (measurement_time - table.key.measurement_time)


def key_of(problem: Problem) -> ProgramKey:
    """The table made for exactly this problem."""
    sigma = float(min(problem.sigma, WIDEST_SIGMA))
    return ProgramKey(
        sigma, float(problem.threshold), float(problem.measurement_time), problem.motion, float(problem.standoff)
    )


def shipped_key(sigma_deg: float, measurement_time_s: float) -> ProgramKey:
    """Of the fielded system (Tables 6.1-6.3) with its fitted movement (6.4.3), but for its sensor."""
    return ProgramKey(
        sigma=math.radians(sigma_deg),
        threshold=10.0,
        measurement_time=float(measurement_time_s),
        motion=LinearConstantMotion(speed=7.0, constant=11.2),
        standoff=50.0,
    )


def _shipped_keys() -> dict[str, ProgramKey]:
    """By their tables' names in the file."""
    sensors = product(SHIPPED_SIGMAS_DEG, SHIPPED_TIMES_S)
    return {f"{degrees} deg, {seconds} s": shipped_key(degrees, seconds) for degrees, seconds in sensors}


@cache
def shipped() -> dict[ProgramKey, ProgramTable]:
    """The tables that are part of the package, so that no plan of the usual mission waits for one."""
    with np.load(SHIPPED, allow_pickle=False) as stored:
        steps = {key: stored[name] for name, key in _shipped_keys().items()}
    return {key: ProgramTable(key, STEP * values.astype(np.float64)) for key, values in steps.items()}


def rounded(table: ProgramTable) -> NDArray[np.uint16]:
    """(SCALES, RATIOS, NODES^2) in STEPs, for the file. ValueError when a value has no room."""
    steps = np.rint(table.after / STEP)
    if steps.min() < 0 or steps.max() > np.iinfo(np.uint16).max:
        raise ValueError(f"values from {table.after.min():.0f} to {table.after.max():.0f} s do not fit the file")
    return steps.astype(np.uint16)


_kept: dict[ProgramKey, ProgramTable] = {}


def keep(table: ProgramTable) -> None:
    """Have a table at hand for every plan to come."""
    _kept[table.key] = table


def program_for(problem: Problem) -> ProgramTable | None:
    """The table at hand that is made for this problem, else the nearest that serves it, else None."""
    wanted = key_of(problem)
    at_hand = {**_kept, **shipped()}
    exact = at_hand.get(wanted)
    if exact is not None:
        return exact
    serving = [table for key, table in at_hand.items() if _apart(key, wanted) <= 1.0]
    return min(serving, key=lambda table: _apart(table.key, wanted), default=None)


def _apart(key: ProgramKey, wanted: ProgramKey) -> float:
    """How far a key is from the wanted one, 1 at the edge of what it serves; infinite where more differs."""
    same = replace(key, sigma=wanted.sigma, measurement_time=wanted.measurement_time)
    if same != wanted:
        return math.inf
    sigma = abs(math.log(key.sigma / wanted.sigma)) / math.log(SIGMA_FACTOR)
    times = max(key.measurement_time, 0.5), max(wanted.measurement_time, 0.5)
    return max(sigma, abs(math.log(times[0] / times[1])) / math.log(TIME_FACTOR))


def compute(key: ProgramKey, transitions_of: Callable[[float], Transitions] | None = None) -> ProgramTable:
    """The table, by value iteration from 0."""
    shape = (transitions_of or compute_transitions)(key.sigma)
    full, speed, constant, acceleration = motion_numbers(key.motion)
    after, _, _ = iterate(
        shape, scales(), ratios(), nodes(), key.threshold, key.measurement_time, full, speed, constant, acceleration,
        key.standoff, SWEEPS, TOLERANCE * max(key.measurement_time, 1.0),
    )  # fmt: skip
    by_scale = np.moveaxis(after, -1, 0).reshape(len(scales()), RATIOS, NODES * NODES)
    return ProgramTable(key, np.ascontiguousarray(by_scale.astype(np.float32).astype(np.float64)))


@lru_cache(1)
def compute_transitions(sigma: float) -> Transitions:
    """What a bearing of noise sigma (rad) does to a Gaussian belief, from every node; not to be written to.

    Two thirds of a table's cost, and the same for a draft whose goal, standoff, speed or turn is changed: the last are
    kept (12 MB).
    """
    shape = (RATIOS, NODES, NODES, DRAWS)
    out = Transitions(*(np.empty(shape) for _ in Transitions._fields))
    transitions(ratios(), nodes(), float(sigma), normal_draws(DRAWS), out)
    return out


def normal_draws(count: int) -> FloatArray:
    """(count, 3) standard normal numbers, quasi-random: the target's place and the bearing's noise, cut at 3."""
    uniform = (sobol(0, count, 3) + 0.5 / count) % 1.0
    return np.column_stack(
        [normal_quantile(uniform[:, 0]), normal_quantile(uniform[:, 1]), normal_quantile(uniform[:, 2], cut=3.0)]
    )


def motion_numbers(motion: Motion) -> tuple[bool, float, float, float]:
    """Whether the ramps count, speed, constant with a mean turn, acceleration."""
    match motion:
        case LinearMotion(speed):
            return False, float(speed), 0.0, 1.0
        case LinearConstantMotion(speed, constant):
            return False, float(speed), float(constant), 1.0
        case FullMotion(turn_rate, acceleration, speed, constant):
            return True, float(speed), float(constant + MEAN_TURN / turn_rate), float(acceleration)


if __name__ == "__main__":
    tables = {name: rounded(compute(key)) for name, key in _shipped_keys().items()}
    np.savez_compressed(SHIPPED, **tables)  # type: ignore[arg-type]  # numpy takes any names
