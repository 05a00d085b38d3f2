"""What a plan for several emitters costs, from the beliefs of a flight that heard all of them once, twice, three times.

What each emitter tells of the compass counts for all of them, as in a new mission.

python -m tests.benchmarks.several_speed --emitters 8 --budget 1000 --repeats 5
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Sequence
from dataclasses import replace
from statistics import median

import numpy as np

from backend.api.suggestion import suggested_mission
from backend.cli.demo import CARRIER, simulated, sought
from backend.cli.truth import HOME
from backend.search.localization import localization
from backend.simulation.emitters import Signal, emitter_places
from planner.belief.joint import JointBelief
from planner.belief.shared_source import with_shared_errors
from planner.options import PlannerOptions
from planner.policy.several import Wanted, paths_among, plan_several
from planner.types import Bearing, Problem
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, write

PLACES = ((0.0, 90.0), (50.0, 190.0), (190.0, 130.0))
OWN = math.radians(1.2)
"""Of the simulated direction finder."""


def flown(emitters: int) -> tuple[list[list[Wanted]], PlannerOptions]:
    """After each of the places: every emitter with its belief, folded with joint and shared errors as a new mission
    does."""
    mission = suggested_mission(HOME).model_copy(update={"emitters": sought(CARRIER, emitters)})
    truth, rng = emitter_places(1, HOME, simulated(mission.emitters)), np.random.default_rng(1)
    tasks = [localization(mission, HOME, emitter.emitter_id) for emitter in mission.emitters]
    heard: list[list[Bearing]] = [[] for _ in tasks]
    after: list[list[Wanted]] = []
    for x, y in PLACES:
        problems: list[Problem] = []
        beliefs: list[JointBelief] = []
        for task, emitter, bearings in zip(tasks, mission.emitters, heard, strict=True):
            east, north = task.frame.to_enu(truth[Signal(emitter.frequency_hz)])
            angle = math.atan2(north - y, east - x) + OWN * float(rng.standard_normal())
            bearings.append(Bearing(x, y, angle, OWN, source="craft:craft-1"))
            belief = task.belief(bearings)
            assert isinstance(belief, JointBelief)
            beliefs.append(belief)
            problems.append(replace(task.problem, sigma=math.hypot(OWN, math.radians(4.0))))
        after.append([Wanted(*one) for one in zip(problems, with_shared_errors(beliefs), strict=True)])
    return after, mission.planner.options


def milliseconds(wanted: Sequence[Wanted], here: tuple[float, float], options: PlannerOptions, repeats: int) -> float:
    """Median; the first plan, which may compile, is not counted."""
    plan_several(wanted, here, options)
    taken: list[float] = []
    for _ in range(repeats):
        began = time.perf_counter()
        plan_several(wanted, here, options)
        taken.append(1e3 * (time.perf_counter() - began))
    return median(taken)


def figures(emitters: int, budget: int, repeats: int) -> list[Figure]:
    """A plan after each of the places."""
    after, suggested = flown(emitters)
    options = replace(suggested, budget=budget)
    paths = paths_among(options.budget, emitters)
    return [
        plain(
            f"a plan for {emitters} emitters, N = {options.budget}, after {number} bearings of each",
            round(milliseconds(wanted, PLACES[number - 1], options, repeats), 1),
            "ms",
            note=f"{paths} paths of each, up to {max(w.belief.density.size for w in wanted)} cells",
        )
        for number, wanted in enumerate(after, start=1)
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description="Time a plan for several emitters.")
    parser.add_argument("--emitters", type=int, default=8)
    parser.add_argument("--budget", type=int, default=1000)
    parser.add_argument("--repeats", type=int, default=5)
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    made = figures(arguments.emitters, arguments.budget, arguments.repeats)
    for figure in made:
        print(f"{figure.name}: {figure.value} {figure.unit} ({figure.note})")
    write(arguments.out, "several_speed", "A plan for several emitters", begun, made, page="several-emitters.md")


if __name__ == "__main__":
    main()
