"""The thesis' test cases: what is known, where the platform starts, where the emitter really is (spec 8)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from planner.options import CellLikelihood, Estimator
from planner.study.errors import StudyError
from planner.types import (
    FloatArray,
    GaussianPrior,
    LinearMotion,
    Prior,
    Problem,
    Ring,
    RingPrior,
    UniformPrior,
)

MEASUREMENT_TIMES: dict[str, float] = {"fast": 2.0, "medium": 10.0, "slow": 40.0}
"""t_m, s (Table 4.1)."""


@dataclass(frozen=True, slots=True)
class Scenario:
    """A problem with its truth. platform: m. target: draws the emitter's place (2,), m, for a run.

    bearing_at_start: whether the first bearing is taken, and its time counted, before the first decision.
    index: which of a fixed series of targets a run has (Scenario 1), else always 0.
    """

    name: str
    problem: Problem
    platform: tuple[float, float]
    target: Callable[[int, np.random.Generator], FloatArray]
    bearing_at_start: bool
    index: Callable[[int], int]


def scenario(
    name: str,
    config: str = "medium",
    *,
    estimator: Estimator | None = None,
    action_grid: tuple[int, int] | None = None,
    measurement_time: float | None = None,
    likelihood: CellLikelihood = "centre",
) -> Scenario:
    """A scenario by name, its configuration and what departs from it. StudyError for names that do not exist."""
    if name not in SCENARIOS:
        raise StudyError(f"there is no scenario {name!r}: choose one of {', '.join(SCENARIOS)}")
    if config not in MEASUREMENT_TIMES:
        raise StudyError(f"there is no configuration {config!r}: choose one of {', '.join(MEASUREMENT_TIMES)}")
    made = SCENARIOS[name](MEASUREMENT_TIMES[config])
    problem = replace(made.problem, likelihood=likelihood)
    if estimator is not None:
        problem = replace(problem, estimator=estimator)
    if action_grid is not None:
        problem = replace(problem, action_grid=action_grid, action_spacing=None)
    if measurement_time is not None:
        if not 0 <= measurement_time < np.inf:
            raise StudyError(f"the measurement time must be a number of seconds, 0 or more, got {measurement_time}")
        problem = replace(problem, measurement_time=measurement_time)
    return replace(made, problem=problem)


def rectangle(width: float, height: float) -> Ring:
    """(4, 2) m, its south-west corner at the origin."""
    return np.array([[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]])


def _thesis_problem(measurement_time: float, prior: Prior | None = None) -> Problem:
    """The numbers that scenarios 1 to 3 share; prior None: uniform."""
    square = (rectangle(300.0, 300.0),)
    return Problem(
        area=square,
        flight_area=square,
        sigma=float(np.deg2rad(4.0)),
        threshold=5.0,
        measurement_time=measurement_time,
        motion=LinearMotion(5.0),
        prior=UniformPrior() if prior is None else prior,
    )


SERIES = np.column_stack([np.full(11, 150.0), np.arange(25.0, 276.0, 25.0)])
"""(11, 2) m: Scenario 1's targets."""


def _one(measurement_time: float) -> Scenario:
    return Scenario(
        "1",
        _thesis_problem(measurement_time),
        (150.0, 0.0),
        target=lambda run, rng: SERIES[run % len(SERIES)],
        bearing_at_start=True,
        index=lambda run: run % len(SERIES),
    )


def _two(measurement_time: float) -> Scenario:
    mean, deviation = np.array([150.0, 150.0]), np.array([10.0, 40.0])

    def target(run: int, rng: np.random.Generator) -> FloatArray:
        while True:
            standard = rng.standard_normal(2)
            if standard @ standard <= 9.0:  # beyond 3 sigma: drawn again
                return mean + deviation * standard

    prior = GaussianPrior(150.0, 150.0, np.diag(deviation**2))
    return Scenario("2", _thesis_problem(measurement_time, prior=prior), (150.0, 0.0), target, False, lambda run: 0)


def _three(measurement_time: float) -> Scenario:
    inner, outer = 30.0, 300.0
    around = (rectangle(600.0, 600.0),)

    def target(run: int, rng: np.random.Generator) -> FloatArray:
        radius = np.sqrt(rng.uniform(inner**2, outer**2))  # uniform in area
        angle = rng.uniform(-np.pi, np.pi)
        return np.array([300.0 + radius * np.cos(angle), 300.0 + radius * np.sin(angle)])

    problem = replace(
        _thesis_problem(measurement_time, RingPrior(300.0, 300.0, inner, outer)),
        estimator="expected_value",
        area=around,
        flight_area=None,
    )
    return Scenario("3", problem, (300.0, 300.0), target, True, lambda run: 0)


def _field(measurement_time: float) -> Scenario:
    """The flown system's numbers (Tables 6.1-6.3); the configuration's measuring time does not apply."""
    del measurement_time
    area = rectangle(313.0, 120.0)
    # The thesis prints 112 actions on a 15 m lattice, not their outline: 14 x 8 squares of it fill this one.
    flight = np.array([[51.5, 0.0], [261.5, 0.0], [261.5, 120.0], [51.5, 120.0]])

    def target(run: int, rng: np.random.Generator) -> FloatArray:
        return rng.uniform((0.0, 0.0), (313.0, 120.0))

    problem = Problem(
        area=(area,),
        flight_area=(flight,),
        sigma=float(np.deg2rad(7.0)),
        threshold=10.0,
        measurement_time=30.0,
        motion=LinearMotion(7.0),
        standoff=50.0,
        action_spacing=15.0,
    )
    return Scenario("field", problem, (156.5, 10.0), target, True, lambda run: 0)


SCENARIOS: dict[str, Callable[[float], Scenario]] = {"1": _one, "2": _two, "3": _three, "field": _field}
