"""Deterministic lookahead: the path of fixed steps with the largest Fisher determinant, by BFGS (thesis Fig. 3.9).

J = P^-1 + sum_k g_k g_k^T / sigma^2 with g = (-y, x) / r^2 and (x, y) the target relative to the k-th place (3.77).
The target is taken to be where the estimate is; it may move with a known velocity, and several platforms may share J.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import minimize

from planner.belief.estimate import estimate
from planner.belief.grid import GridBelief
from planner.policy.feasible import nearest_feasible
from planner.policy.information import bearing_gradient, prior_information
from planner.reasons import FirstOfRoute
from planner.types import Decision, FloatArray, Problem


@dataclass(frozen=True, slots=True)
class Course:
    """What is flown: P platforms make K steps each, one bearing after every step.

    starts: (P, 2) m. step: m a platform flies between two bearings. steps: K. target: (2,) m at the start.
    velocity: (2,) m that the target moves in one step. sigma: rad. information: (2, 2) 1/m^2, what is known already
    (P^-1; zero: nothing). bearing_at_start: whether each platform also takes one where it starts. closest: m, ranges
    below it count as it does: the determinant has a pole at the target.
    """

    starts: FloatArray
    step: float
    steps: int
    target: FloatArray
    sigma: float
    velocity: FloatArray = field(default_factory=lambda: np.zeros(2))
    information: FloatArray = field(default_factory=lambda: np.zeros((2, 2)))
    bearing_at_start: bool = True
    closest: float = 1e-3

    def __post_init__(self) -> None:
        if self.steps < 1 or not self.step > 0 or not self.sigma > 0:
            raise ValueError("a course needs at least one step, a positive step length and a positive sigma")
        for name in ("starts", "target", "velocity", "information"):
            object.__setattr__(self, name, np.array(getattr(self, name), dtype=np.float64))
        object.__setattr__(self, "starts", np.atleast_2d(self.starts))


def places(course: Course, headings: FloatArray) -> FloatArray:
    """(P, K + 1, 2) places, m, start included, of `headings` (P, K), rad."""
    moves = course.step * np.stack([np.cos(headings), np.sin(headings)], axis=-1)
    return np.concatenate([course.starts[:, None], course.starts[:, None] + np.cumsum(moves, axis=1)], axis=1)


def log_determinant(course: Course, headings: FloatArray) -> tuple[float, FloatArray]:
    """log det J of the course and its gradient (P, K) with respect to the headings."""
    relative, r2, g = _bearings(course, headings)
    x, y = relative[..., 0], relative[..., 1]
    information = _summed(course, g)
    determinant = float(np.linalg.det(information))
    if not determinant > 1e-250:
        return -575.0, np.zeros_like(headings)
    inverse = np.linalg.inv(information)
    # d log det J / dg = 2 J^-1 g / sigma^2, then dg / d(x, y), then minus: the sensor moves, not the target
    pull = 2.0 * g @ inverse / course.sigma**2
    along = (pull * g).sum(axis=-1)
    d_x = pull[..., 1] / r2 - 2.0 * x / r2 * along
    d_y = -pull[..., 0] / r2 - 2.0 * y / r2 * along
    later_x = np.cumsum(-d_x[:, :0:-1], axis=1)[:, ::-1]  # the k-th heading moves every later place
    later_y = np.cumsum(-d_y[:, :0:-1], axis=1)[:, ::-1]
    gradient = course.step * (-np.sin(headings) * later_x + np.cos(headings) * later_y)
    return float(np.log(determinant)), gradient


def optimal_headings(course: Course) -> FloatArray:
    """(P, K) headings, rad, of the best of several BFGS descents from nearly straight courses to either side."""
    shape = (len(course.starts), course.steps)
    toward = np.arctan2(*(course.target - course.starts).T[::-1])[:, None]
    sides = np.where(np.arange(shape[0]) % 2 == 0, 1.0, -1.0)[:, None]

    def objective(flat: FloatArray) -> tuple[float, FloatArray]:
        value, gradient = log_determinant(course, flat.reshape(shape))
        return -value, -gradient.ravel()

    best, least = np.broadcast_to(toward, shape), np.inf
    for offset in np.deg2rad([20.0, 50.0, 80.0, -20.0, -50.0, -80.0]):
        # Platforms start to opposite sides; the slight bend keeps the descent off a straight line's saddle.
        initial = toward + sides * offset * np.linspace(1.1, 0.9, shape[1])
        found = minimize(objective, initial.ravel(), jac=True, method="BFGS", options={"gtol": 1e-4})
        if found.fun < least - 1e-9:
            best, least = found.x.reshape(shape), found.fun
    return np.array(best)


def myopic_headings(course: Course) -> FloatArray:
    """(P, K) headings when every step is chosen for the determinant right after it."""
    chosen = np.empty((len(course.starts), 0))
    information, starts = course.information, course.starts
    for step in range(course.steps):
        now = Course(
            starts=starts,
            step=course.step,
            steps=1,
            target=course.target + course.velocity * step,
            sigma=course.sigma,
            velocity=course.velocity,
            information=information,
            bearing_at_start=course.bearing_at_start and step == 0,
            closest=course.closest,
        )
        headings = optimal_headings(now)
        information = fisher_information(now, headings)
        starts = places(now, headings)[:, -1]
        chosen = np.concatenate([chosen, headings], axis=1)
    return chosen


def fisher_information(course: Course, headings: FloatArray) -> FloatArray:
    """(2, 2) J, 1/m^2, of a flown course."""
    return _summed(course, _bearings(course, headings)[2])


def _bearings(course: Course, headings: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The target relative to the places (P, K + 1, 2), m, squared ranges (P, K + 1), and the bearings' gradients g."""
    times = np.arange(course.steps + 1)
    relative = course.target + course.velocity * times[:, None] - places(course, headings)
    r2 = (relative**2).sum(axis=-1) + course.closest**2
    g = bearing_gradient(relative, r2)
    if not course.bearing_at_start:
        g[:, 0] = 0.0
    return relative, r2, g


def _summed(course: Course, g: FloatArray) -> FloatArray:
    return course.information + np.einsum("pki,pkj->ij", g, g) / course.sigma**2


RATIOS: Sequence[float] = (0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0)


def stationary_course(ratio: float, steps: int = 20, distance: float = 1.0) -> Course:
    """Fig. 3.9's stationary target: a path of `ratio` times the first distance, from (0, 0) to a target in the east."""
    return Course(
        starts=np.zeros((1, 2)),
        step=ratio * distance / steps,
        steps=steps,
        target=np.array([distance, 0.0]),
        sigma=np.deg2rad(1.0),
        closest=0.02 * distance,
    )


@dataclass(frozen=True, slots=True)
class Lookahead:
    """As a policy: the first place of the best course of `steps` steps of `step` m each, planned again every time."""

    steps: int = 4
    step: float = 40.0

    def __call__(
        self,
        problem: Problem,
        belief: GridBelief,
        platform: tuple[float, float],
        rng: np.random.Generator | None = None,
    ) -> Decision:
        """`rng` is not used."""
        estimated = estimate(belief, problem.estimator)
        course = Course(
            starts=np.array([platform]),
            step=self.step,
            steps=self.steps,
            target=np.array([estimated.x, estimated.y]),
            sigma=problem.sigma,
            information=prior_information(estimated),
            bearing_at_start=False,
            closest=max(belief.h, problem.threshold),
        )
        x, y = nearest_feasible(problem, belief, places(course, optimal_headings(course))[0, 1])
        return Decision(float(x), float(y), reason=FirstOfRoute(course.steps, "lookahead"))


lookahead = Lookahead()
