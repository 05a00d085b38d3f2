"""Planning for a craft that turns at no place (`Legs`): which places are far enough, and what a bearing takes.

A rollout's later places may lie next to each other, or be one and the same; in flight no leg is shorter than `least`.
Each later bearing is therefore charged the shortest leg besides its own way, at most that much too long:

    t_later = pause + least / speed
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from planner.types import FloatArray, Problem


def far_enough(problem: Problem, platform: FloatArray, places: FloatArray) -> FloatArray:
    """(k, 2) m: those of the places (n, 2) that a leg from the platform (2,) may lead to; the two furthest where the
    flight area has none."""
    if problem.legs is None or len(places) == 0:
        return places
    away = np.hypot(*(places - platform).T)
    return places[away >= min(problem.legs.least, np.sort(away)[-min(2, len(away))])]


def flown_by_legs(problem: Problem) -> Problem:
    """Its bearings are those of legs, as rollouts take them; as it is where a bearing is a turn."""
    if problem.legs is None:
        return problem
    later = problem.legs.pause + problem.legs.least / problem.motion.speed
    return replace(problem, sigma=problem.legs.sigma, measurement_time=later)


def first_time(problem: Problem) -> float:
    """s that the first bearing takes besides its way."""
    return problem.measurement_time if problem.legs is None else problem.legs.pause
